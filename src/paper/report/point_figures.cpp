// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "dermis/out/report/estimator_table.hpp"
#include "dermis/out/report/plot.hpp"
#include "dermis/out/report/wording.hpp"
#include "paper/report/paper_figures.hpp"
#include "paper/report/paper_points.hpp"

namespace dermis::paper {

using out::report::Axis;
using out::report::Drawing;
using out::report::Figure;
using out::report::fine_percent;
using out::report::kPaperTolerance;
using out::report::nice_axis;
using out::report::Plot;
using out::report::Point;
using out::report::Scale;

namespace {

constexpr std::size_t kOutputStyle = 6;
constexpr double kWidth = 400.0;
constexpr double kHeight = 330.0;

using Value = std::function<double(const PaperPoint&)>;

/// Values at the action points 1, 2, ...; what is not finite becomes NaN, which plots leave out.
std::vector<Point> series(const PaperLevel& level, const Value& value) {
  std::vector<Point> points;
  for (const PaperPoint& point : level.points) {
    const double y = value(point);
    points.push_back(
        {static_cast<double>(points.size() + 1), std::isfinite(y) ? y : std::numeric_limits<double>::quiet_NaN()});
  }
  return points;
}

Axis point_axis(const PaperLevel& level) {
  const std::size_t count = level.points.size();
  Axis axis{"action point", Scale::linear, 0.5, static_cast<double>(count) + 0.5, {}};
  const std::size_t step = (count + 15) / 16;
  for (std::size_t i = 1; i <= count; i += step) axis.ticks.push_back(static_cast<double>(i));
  return axis;
}

Axis value_axis(std::string label, const std::vector<std::vector<Point>>& all) {
  std::vector<double> values;
  for (const std::vector<Point>& points : all) {
    for (const Point& point : points) values.push_back(point.y);
  }
  return nice_axis(std::move(label), Scale::linear, values);
}

/// A curve times a factor.
std::vector<Point> scaled(std::vector<Point> points, double factor) {
  for (Point& point : points) point.y *= factor;
  return points;
}

/// From the lower curve and back along the upper one.
std::vector<Point> outline(const std::vector<Point>& lower, const std::vector<Point>& upper) {
  std::vector<Point> points;
  for (const Point& point : lower) {
    if (std::isfinite(point.y)) points.push_back(point);
  }
  for (std::size_t i = upper.size(); i-- > 0;) {
    if (std::isfinite(upper[i].y)) points.push_back(upper[i]);
  }
  return points;
}

/// The reference of the points, and the paper's 5 % around it.
void draw_calibration(Plot& plot, const std::vector<Point>& calibration) {
  const std::vector<Point> lower = scaled(calibration, 1.0 - kPaperTolerance);
  const std::vector<Point> upper = scaled(calibration, 1.0 + kPaperTolerance);
  plot.region("\u00b15 %", outline(lower, upper));
  plot.reference("calibration", calibration);
}

std::vector<Point> level_line(const Axis& x, double value) {
  return {{x.low, value}, {x.high, value}};
}

Drawing voltage_panel(const PaperLevel& level) {
  const std::vector<Point> output = series(level, [](const PaperPoint& point) { return point.output_v; });
  const std::vector<Point> calibration = series(level, [](const PaperPoint& point) { return point.calibration_v; });
  const Axis y = value_axis("output voltage [V]", {output, scaled(calibration, 1.0 - 1.4 * kPaperTolerance),
                                                   scaled(calibration, 1.0 + 1.4 * kPaperTolerance)});
  Plot plot(fmt::format("{:.4g} N: voltage", level.newtons), point_axis(level), y, kWidth, kHeight);
  draw_calibration(plot, calibration);
  plot.curve("output", kOutputStyle, output);
  return plot.drawing();
}

Drawing force_panel(const PaperLevel& level, std::size_t style) {
  const std::vector<Point> bank = series(level, [](const PaperPoint& point) { return point.bank_newtons; });
  const std::vector<Point> dermis = series(level, [](const PaperPoint& point) { return point.dermis_newtons; });
  const Axis x = point_axis(level);
  const std::vector<Point> calibration = level_line(x, level.newtons);
  const Axis y = value_axis("force [N]", {bank, dermis, scaled(calibration, 1.0 - 1.4 * kPaperTolerance),
                                          scaled(calibration, 1.0 + 1.4 * kPaperTolerance)});
  Plot plot(fmt::format("{:.4g} N: force", level.newtons), x, y, kWidth, kHeight);
  draw_calibration(plot, calibration);
  plot.curve("dermis", 0, dermis);
  plot.curve("bank", style, bank);
  return plot.drawing();
}

Drawing error_panel(const PaperLevel& level, std::size_t style) {
  const std::vector<Point> bank = series(level, [](const PaperPoint& point) { return 100.0 * bank_error(point); });
  const std::vector<Point> dermis = series(level, [](const PaperPoint& point) { return 100.0 * dermis_error(point); });
  const Axis x = point_axis(level);
  const double band = 100.0 * kPaperTolerance;
  const Axis y =
      value_axis("relative error [%]", {bank, dermis, level_line(x, -1.4 * band), level_line(x, 1.4 * band)});
  Plot plot(fmt::format("{:.4g} N: relative error", level.newtons), x, y, kWidth, kHeight);
  plot.region("\u00b15 %", outline(level_line(x, -band), level_line(x, band)));
  plot.reference("", level_line(x, 0.0));
  plot.curve("dermis", 0, dermis);
  plot.curve("bank", style, bank);
  return plot.drawing();
}

std::string missing_sentence(const PaperLevel& level, const char* name, PointError error) {
  std::size_t missing = 0;
  for (const PaperPoint& point : level.points) missing += std::isfinite(error(point)) ? 0U : 1U;
  if (missing == 0) return "";
  return fmt::format(" {} gives no force at {} of {} points; they are not drawn.", name, missing, level.points.size());
}

Figure level_figure(const PaperReproduction& reproduction, const PaperLevel& level) {
  Figure figure{
      fmt::format("paper_fig_{}.svg", level.paper_figure),
      fmt::format("Output and calibration at {:.4g} N (the paper's Fig. {})", level.newtons, level.paper_figure),
      fmt::format("No point was judged at {:.4g} N.", level.newtons),
      {},
      3};
  if (level.points.empty()) return figure;
  const std::size_t style = bank_style(reproduction);
  figure.panels = {voltage_panel(level), force_panel(level, style), error_panel(level, style)};
  figure.caption = fmt::format("Largest relative error: voltage {}, the paper's bank {}, dermis {}.",
                               fine_percent(worst_error(level.points, voltage_error)),
                               fine_percent(worst_error(level.points, bank_error)),
                               fine_percent(worst_error(level.points, dermis_error))) +
                   missing_sentence(level, "The bank", bank_error) + missing_sentence(level, "dermis", dermis_error);
  return figure;
}

}  // namespace

std::vector<Figure> point_figures(const PaperReproduction& reproduction) {
  std::vector<Figure> figures;
  for (const PaperLevel& level : paper_levels(reproduction)) figures.push_back(level_figure(reproduction, level));
  return figures;
}

}  // namespace dermis::paper
