// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/sheet/taxel_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kLeastSigmas = 5.0;  // of the noise, for a logarithm
constexpr double kBinsPerUnit = 2.5;  // of the logarithm of the force
constexpr double kLeastSpan = 0.7;    // of the logarithm of the force, for the slope of an end
constexpr int kRounds = 3;
constexpr double kLeastSlope = 0.2;
constexpr double kMostSlope = 4.0;

struct Bin {
  double log_newtons = 0.0;  // sums
  double log_siemens = 0.0;
  double count = 0.0;

  void add(double newtons, double siemens) {
    log_newtons += newtons;
    log_siemens += siemens;
    count += 1.0;
  }
};

/// Value at x of the line through both points.
template <typename Point>
double line(const Point& a, const Point& b, double x) {
  return a.log_siemens + (x - a.log_newtons) * (b.log_siemens - a.log_siemens) / (b.log_newtons - a.log_newtons);
}

template <typename Points>
double between(const Points& points, double x) {
  const auto after = std::lower_bound(points.begin(), points.end(), x,
                                      [](const auto& point, double value) { return point.log_newtons < value; });
  if (after == points.begin()) return after->log_siemens;
  if (after == points.end()) return points.back().log_siemens;
  return line(*(after - 1), *after, x);
}

}  // namespace

TaxelCurves::Points TaxelCurves::points(const SinglePresses& single) {
  Points measured;
  for (const auto& [taxel, newtons, temperature, rise, held] : single.presses) {
    if (!(rise[taxel] > kLeastSigmas * single.sigma[taxel])) continue;
    measured.push_back({std::log(newtons), std::log(rise[taxel]), temperature, taxel});
  }
  return measured;
}

TaxelCurves::TaxelCurves(const SinglePresses& single, const TaxelCurves& known)
    : per_temperature_(known.per_temperature_), per_square_(known.per_square_), taxel_(known.taxel_) {
  Points measured = points(single);
  for (Point& point : measured) point.log_siemens -= own_at(point.taxel, point.log_newtons);
  fit_sheet(measured, std::vector<double>(taxel_.size()));
}

TaxelCurves::TaxelCurves(const SinglePresses& single) : taxel_(single.sigma.size()) {
  const Points measured = points(single);
  std::vector<double> level(taxel_.size());
  for (int round = 0; round < kRounds; ++round) {
    fit_sheet(measured, level);
    if (!any()) return;
    fit_temperature(measured, level);
    fit_levels(measured, level);
  }
  std::vector<std::map<double, Bin>> by_force(taxel_.size());
  for (const Point& point : measured) {
    by_force[point.taxel][point.log_newtons].add(point.log_newtons, above_sheet(point));
  }
  for (std::size_t taxel = 0; taxel < taxel_.size(); ++taxel) {
    for (const auto& [force, bin] : by_force[taxel]) {
      taxel_[taxel].push_back({force, bin.log_siemens / bin.count, 0.0, taxel});
    }
  }
}

double TaxelCurves::own_at(std::size_t taxel, double log_newtons) const {
  return taxel_[taxel].empty() ? 0.0 : between(taxel_[taxel], log_newtons);
}

double TaxelCurves::above_sheet(const Point& point) const {
  return point.log_siemens - temperature_factor(point.temperature) - of_sheet(point.log_newtons);
}

double TaxelCurves::temperature_factor(double t) const {
  return t * (per_temperature_ + t * per_square_);
}

double TaxelCurves::at_middle(double siemens, double temperature) const {
  return siemens * std::exp(-temperature_factor(temperature));
}

/// Means in bins of the force, the level of each taxel taken out.
void TaxelCurves::fit_sheet(const Points& measured, const std::vector<double>& level) {
  std::map<int, Bin> bins;
  for (const Point& point : measured) {
    const double siemens = point.log_siemens - temperature_factor(point.temperature) - level[point.taxel];
    bins[static_cast<int>(std::floor(kBinsPerUnit * point.log_newtons))].add(point.log_newtons, siemens);
  }
  sheet_.clear();
  for (const auto& [place, bin] : bins) {
    sheet_.push_back({bin.log_newtons / bin.count, bin.log_siemens / bin.count, 0.0, 0});
  }
}

/// A parabola through 0 at the middle of the temperatures, by least squares.
void TaxelCurves::fit_temperature(const Points& measured, const std::vector<double>& level) {
  double tt = 0.0;
  double ttt = 0.0;
  double tttt = 0.0;
  double ty = 0.0;
  double tty = 0.0;
  for (const Point& point : measured) {
    const double t = point.temperature;
    const double y = above_sheet(point) + temperature_factor(t) - level[point.taxel];
    tt += t * t;
    ttt += t * t * t;
    tttt += t * t * t * t;
    ty += t * y;
    tty += t * t * y;
  }
  const double determinant = tt * tttt - ttt * ttt;
  if (!(determinant > 1e-9 * tt * tttt)) return;
  per_temperature_ = (tttt * ty - ttt * tty) / determinant;
  per_square_ = (tt * tty - ttt * ty) / determinant;
}

void TaxelCurves::fit_levels(const Points& measured, std::vector<double>& level) const {
  std::vector<std::vector<double>> above(level.size());
  for (const Point& point : measured) above[point.taxel].push_back(above_sheet(point));
  for (std::size_t taxel = 0; taxel < level.size(); ++taxel) {
    if (!above[taxel].empty()) level[taxel] = quantile(std::move(above[taxel]), 0.5);
  }
}

/// Cubics through the points with the slopes of the parabolas through each three of them.
double TaxelCurves::of_sheet(double log_newtons) const {
  const auto after = std::lower_bound(sheet_.begin(), sheet_.end(), log_newtons,
                                      [](const Point& point, double value) { return point.log_newtons < value; });
  const auto last = static_cast<std::size_t>(after - sheet_.begin());
  const auto beyond = [&](std::size_t end) {
    const double slope = std::clamp(end_slope(end), kLeastSlope, kMostSlope);
    return sheet_[end].log_siemens + slope * (log_newtons - sheet_[end].log_newtons);
  };
  if (last == 0) return beyond(0);
  if (last == sheet_.size()) return beyond(last - 1);
  const Point& low = sheet_[last - 1];
  const Point& high = sheet_[last];
  const double span = high.log_newtons - low.log_newtons;
  const double t = (log_newtons - low.log_newtons) / span;
  const double off_low = span * slope_at(last - 1) - (high.log_siemens - low.log_siemens);
  const double off_high = span * slope_at(last) - (high.log_siemens - low.log_siemens);
  return low.log_siemens + t * (high.log_siemens - low.log_siemens) +
         t * (1.0 - t) * ((1.0 - t) * off_low - t * off_high);
}

/// That of the first or last points, which are far enough from each other not to follow noise.
double TaxelCurves::end_slope(std::size_t end) const {
  if (are_straight()) return 1.0;
  const Point& at = sheet_[end];
  std::size_t inner = end == 0 ? 1 : end - 1;
  const std::size_t step = end == 0 ? 1 : std::numeric_limits<std::size_t>::max();  // -1
  while (inner > 0 && inner + 1 < sheet_.size() && std::abs(sheet_[inner].log_newtons - at.log_newtons) < kLeastSpan) {
    inner += step;
  }
  return (sheet_[inner].log_siemens - at.log_siemens) / (sheet_[inner].log_newtons - at.log_newtons);
}

double TaxelCurves::slope_at(std::size_t point) const {
  const std::size_t middle = std::clamp<std::size_t>(point, 1, std::max<std::size_t>(sheet_.size() - 2, 1));
  const auto slope = [&](std::size_t k) {
    return (sheet_[k + 1].log_siemens - sheet_[k].log_siemens) / (sheet_[k + 1].log_newtons - sheet_[k].log_newtons);
  };
  if (sheet_.size() == 2) return slope(0);
  const double before = sheet_[middle].log_newtons - sheet_[middle - 1].log_newtons;
  const double behind = sheet_[middle + 1].log_newtons - sheet_[middle].log_newtons;
  const double bend = (slope(middle) - slope(middle - 1)) / (before + behind);
  return slope(middle - 1) +
         bend * (2.0 * sheet_[point].log_newtons - sheet_[middle - 1].log_newtons - sheet_[middle].log_newtons);
}

double TaxelCurves::siemens(std::size_t taxel, double newtons) const {
  if (!(newtons > 0.0)) return 0.0;
  const double log_newtons = std::log(newtons);
  return std::exp(of_sheet(log_newtons) + own_at(taxel, log_newtons));
}

}  // namespace dermis::learn::calibration
