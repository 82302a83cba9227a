// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "dermis/out/report/plot.hpp"
#include "out/report/figures.hpp"

namespace dermis::out::report {
namespace {

using learn::calibration::Evaluation;
using learn::calibration::JudgedTaxel;
using learn::calibration::JudgedTotal;
using learn::calibration::TouchTime;

constexpr double kWidth = 480.0;
constexpr double kHeight = 350.0;

/// A load from its onset on, label by label.
struct Touch {
  std::vector<Point> truth;     // [s], [N]
  std::vector<Point> estimate;  // likewise, by the first estimator
  std::vector<bool> falls;
};

/// One with loading and unloading shows more than one without, and a long one more than a short one.
bool tells_more(const Touch& a, const Touch& b) {
  const auto rank = [](const Touch& touch) {
    const auto falling = std::count(touch.falls.begin(), touch.falls.end(), true);
    return std::pair(falling > 0, touch.truth.size());
  };
  return rank(a) > rank(b);
}

/// The touches of a place follow each other; `current` is the last one of it.
void add(const TouchTime& time, double true_newtons, double newtons, Touch& current, Touch& best) {
  if (!time.seconds_since_onset) return;
  const double seconds = *time.seconds_since_onset;
  if (!current.truth.empty() && seconds <= current.truth.back().x) current = {};
  current.truth.push_back({seconds, true_newtons});
  current.estimate.push_back({seconds, newtons});
  current.falls.push_back(time.is_unloading.value_or(false));
  if (tells_more(current, best)) best = current;
}

Touch best_touch(const Evaluation& evaluation) {
  Touch best;
  std::map<std::size_t, Touch> current;
  for (const JudgedTaxel& taxel : evaluation.taxels) {
    add(taxel.touch, taxel.true_newtons, static_cast<double>(taxel.newtons.front()), current[taxel.taxel], best);
  }
  if (!best.truth.empty()) return best;
  Touch of_totals;
  for (const JudgedTotal& total : evaluation.totals) {
    add(total.touch, total.true_newtons, total.newtons.front(), of_totals, best);
  }
  return best;
}

Axis force_axis(std::string label, const Touch& touch) {
  std::vector<double> values{0.0};
  for (const Point& point : touch.truth) values.push_back(point.y);
  for (const Point& point : touch.estimate) values.push_back(point.y);
  return nice_axis(std::move(label), Scale::linear, values);
}

Drawing over_time(const Touch& touch) {
  const std::vector<double> seconds{0.0, touch.truth.back().x};
  Plot plot("", nice_axis("time since the load came [s]", Scale::linear, seconds), force_axis("force [N]", touch),
            kWidth, kHeight);
  plot.reference("true force", touch.truth);
  plot.line("dermis", 0, touch.estimate);
  return plot.drawing();
}

/// Loading and unloading lie on one another where nothing is remembered.
Drawing loop(const Touch& touch) {
  const Axis x = force_axis("true force [N]", touch);
  Plot plot("", x, force_axis("force by dermis [N]", touch), kWidth, kHeight);
  plot.reference("right", {{x.low, x.low}, {x.high, x.high}});
  std::vector<Point> loading;
  std::vector<Point> unloading;
  for (std::size_t k = 0; k < touch.truth.size(); ++k) {
    (touch.falls[k] ? unloading : loading).push_back({touch.truth[k].y, touch.estimate[k].y});
  }
  plot.cloud("loading", 0, std::move(loading));
  if (!unloading.empty()) plot.cloud("unloading", 1, std::move(unloading));
  return plot.drawing();
}

}  // namespace

Figure touch_figure(const Evaluation& evaluation) {
  Figure figure{
      "touch_over_time.svg", "A touch over time", "No load was seen coming, so there is no touch over time.", {}};
  const Touch touch = best_touch(evaluation);
  if (touch.truth.size() < 2) return figure;
  figure.panels = {over_time(touch), loop(touch)};
  figure.columns = 2;
  figure.caption =
      "The longest touch with known forces, of those that also get lighter where there are such: the force over time, "
      "and against the true force.";
  return figure;
}

}  // namespace dermis::out::report
