// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "dermis/out/report/heat_map.hpp"
#include "dermis/out/report/plot.hpp"
#include "dermis/out/report/wording.hpp"
#include "paper/report/network_diagram.hpp"
#include "paper/report/paper_figures.hpp"
#include "paper/report/surface.hpp"
#include "paper/report/training_plot.hpp"

namespace dermis::paper {

using out::report::Axis;
using out::report::Colours;
using out::report::counted;
using out::report::Drawing;
using out::report::Figure;
using out::report::heat_map;
using out::report::heat_map_high;
using out::report::MapAxes;
using out::report::nice_axis;
using out::report::Plot;
using out::report::Point;
using out::report::Scale;
using out::report::three_digits;

namespace {

constexpr double kReach = 3.0;  // x and y of Peaks lie in -3 ... 3.
constexpr const char* kNoSurface = "The output of the network is not known, so there is no error to show.";

bool has_surface(const PeaksReproduction& peaks) {
  const std::size_t count = peaks.side * peaks.side;
  return peaks.side >= 2 && peaks.target.size() == count && peaks.output.size() == count;
}

/// Output less target.
std::vector<double> errors_of(const PeaksReproduction& peaks) {
  std::vector<double> errors(peaks.target.size());
  std::transform(peaks.output.begin(), peaks.output.end(), peaks.target.begin(), errors.begin(), std::minus<>());
  return errors;
}

double largest_magnitude(const std::vector<double>& values) {
  std::vector<double> magnitudes(values.size());
  std::transform(values.begin(), values.end(), magnitudes.begin(), [](double value) { return std::abs(value); });
  constexpr double kSmallest = 1e-100;  // Beyond these the ends of a scale could leave the range of a double.
  constexpr double kLargest = 1e100;
  return std::clamp(heat_map_high(magnitudes), kSmallest, kLargest);
}

Drawing map_of(const PeaksReproduction& peaks, std::string title, std::vector<double> values, double high) {
  const double half_cell = kReach / static_cast<double>(peaks.side - 1);
  const Axis x{"x", Scale::linear, -kReach - half_cell, kReach + half_cell, {-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0}};
  Axis y = x;
  y.label = "y";
  return heat_map({std::move(title), peaks.side, peaks.side, 1.0, 1.0, high, std::move(values), Colours::diverging,
                   MapAxes{x, std::move(y)}});
}

/// Every second row and column of a grid of an odd number of them.
std::vector<double> every_second(const std::vector<double>& values, std::size_t side) {
  std::vector<double> thinned;
  for (std::size_t row = 0; row < side; row += 2) {
    for (std::size_t col = 0; col < side; col += 2) thinned.push_back(values[row * side + col]);
  }
  return thinned;
}

Drawing surface_of(const PeaksReproduction& peaks, std::string title, std::string label, std::vector<double> values) {
  const double high = largest_magnitude(values);
  const Axis x{"x", Scale::linear, -kReach, kReach, {-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0}};
  Axis y = x;
  y.label = "y";
  const Axis z = nice_axis(std::move(label), Scale::linear, std::vector<double>{-high, high});
  std::size_t side = peaks.side;
  if (side % 2 == 1 && side > 3) {
    values = every_second(values, side);
    side = (side + 1) / 2;
  }
  return surface({std::move(title), x, std::move(y), z, side, side, std::move(values)});
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::vector<Point> positive_points(const std::vector<HiddenLayerFit>& fits, double HiddenLayerFit::*mse) {
  std::vector<Point> points;
  for (const HiddenLayerFit& fit : fits) {
    if (std::isfinite(fit.*mse) && fit.*mse > 0.0) points.push_back({static_cast<double>(fit.hidden), fit.*mse});
  }
  return points;
}

Axis hidden_axis(const std::vector<HiddenLayerFit>& fits) {
  Axis axis{"hidden units", Scale::linear, 0.0, 0.0, {}};
  for (const HiddenLayerFit& fit : fits) axis.ticks.push_back(static_cast<double>(fit.hidden));
  axis.low = axis.ticks.front() - 0.5;
  axis.high = axis.ticks.back() + 0.5;
  return axis;
}

}  // namespace

Figure peaks_network_figure() {
  const NetworkDiagram diagram{"2-5-1",
                               {{"input", "", {"x", "y"}},
                                {"hidden layer", "log-sigmoid, eq. (3)", {"1", "2", "3", "4", "5"}},
                                {"output layer", "linear", {"z"}}}};
  return {"paper_fig_05.svg",
          "The network for Peaks (the paper's Fig. 5)",
          "10 + 5 connections and 5 + 1 thresholds: 21 unknowns against 3,721 samples.",
          {network_diagram(diagram)},
          1};
}

Figure peaks_surface_figure(const PeaksReproduction& peaks) {
  Figure figure{"paper_fig_06.svg", "Error surface (the paper's Fig. 6)", kNoSurface, {}, 1};
  if (!has_surface(peaks)) return figure;
  const std::vector<double> errors = errors_of(peaks);
  figure.panels.push_back(surface_of(peaks, "error of the best 2-5-1 network", "output - target", errors));
  figure.caption = fmt::format(
      "Output less target of the best 2-5-1 network that was found by any algorithm, in the units of Peaks{}. Largest "
      "magnitude {}, root mean square {}.",
      peaks.range > 0.0 ? fmt::format(" (which spans {})", three_digits(peaks.range)) : "",
      three_digits(largest_magnitude(errors)), three_digits(root_mean_square(errors)));
  return figure;
}

Figure peaks_maps_figure(const PeaksReproduction& peaks) {
  Figure figure{"peaks_maps.svg", "Peaks, eq. (1), and the best 2-5-1 network", kNoSurface, {}, 3};
  if (!has_surface(peaks)) return figure;
  const std::vector<double> errors = errors_of(peaks);
  const double high = std::max(largest_magnitude(peaks.target), largest_magnitude(peaks.output));
  figure.panels = {map_of(peaks, "target z", peaks.target, high), map_of(peaks, "output of 2-5-1", peaks.output, high),
                   map_of(peaks, "output - target", errors, largest_magnitude(errors))};
  figure.caption = fmt::format(
      "{0} x {0} samples. Target and output share one scale; the error has its own. White is zero.", peaks.side);
  return figure;
}

Figure peaks_training_figure(const PeaksReproduction& peaks) {
  const TrainingCurve& curve = peaks.adaptive_rate_curve;
  Figure figure{"peaks_training.svg",
                "Training of 2-5-1 by gradient descent",
                "No training by gradient descent is known.",
                {},
                1};
  if (!has_points(curve)) return figure;
  figure.panels.push_back(training_plot({"traingdx, best start", "E, eq. (2)", {{0, &curve}}, peaks.goal}));
  figure.caption = fmt::format(
      "Gradient descent with adaptive rate and momentum (MATLAB's traingdx), as in the paper: the best of {}. It ends "
      "at E = {} after {}; the goal is {}.",
      counted(peaks.adaptive_rate_starts, "random start"), three_digits(peaks.adaptive_rate_best_mse),
      counted(peaks.adaptive_rate_epochs, "step"),
      peaks.adaptive_rate_best_mse <= peaks.goal ? "reached" : "not reached");
  return figure;
}

Figure hidden_units_figure(const PeaksReproduction& peaks) {
  Figure figure{
      "peaks_hidden_units.svg", "Size of the hidden layer", "No sizes of the hidden layer were tried.", {}, 1};
  if (peaks.by_hidden.empty()) return figure;
  const std::vector<Point> raw = positive_points(peaks.by_hidden, &HiddenLayerFit::best_mse);
  const std::vector<Point> scaled = positive_points(peaks.by_hidden, &HiddenLayerFit::best_mse_normalised);
  std::vector<double> errors = {peaks.goal / 2.0};  // So that the goal does not lie on the frame.
  for (const Point& point : raw) errors.push_back(point.y);
  for (const Point& point : scaled) errors.push_back(point.y);
  const Axis x = hidden_axis(peaks.by_hidden);
  Plot plot("best fit by Levenberg-Marquardt", x, nice_axis("E, eq. (2)", Scale::logarithmic, errors), 480.0, 350.0);
  plot.reference(fmt::format("goal {:.3g}", peaks.goal), {{x.low, peaks.goal}, {x.high, peaks.goal}});
  plot.curve("in the units of Peaks", 0, raw);
  plot.curve("targets scaled to [0, 1]", 1, scaled);
  figure.panels.push_back(plot.drawing());
  figure.caption = "The lowest E that was found with each size of the hidden layer, for both scalings of the targets.";
  if (peaks.range > 0.0) {
    figure.caption +=
        fmt::format(" On targets scaled to [0, 1] the goal is {} in the units of Peaks, {} times as much.",
                    three_digits(peaks.goal * peaks.range * peaks.range), three_digits(peaks.range * peaks.range));
  }
  return figure;
}

}  // namespace dermis::paper
