// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/sheet/taxel_curves.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kLeastSigmas = 5.0;     // of the noise, for a logarithm
constexpr double kBinsPerUnit = 2.5;     // of the logarithm of the force
constexpr double kLeastSlopeSpan = 0.7;  // the same, for the slope of an end
constexpr int kRounds = 3;
constexpr double kLeastSlope = 0.2;
constexpr double kMostSlope = 4.0;

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

TaxelCurves::TaxelCurves(const SinglePresses& single) : taxel_(single.unloaded.size()) {
  std::vector<std::map<double, std::pair<double, double>>> sums(taxel_.size());  // by force: sum, count
  for (const auto& [taxel, newtons, siemens] : single.presses) {
    auto& [sum, count] = sums[taxel][newtons];
    sum += siemens[taxel] - single.unloaded[taxel];
    count += 1.0;
  }
  for (std::size_t taxel = 0; taxel < taxel_.size(); ++taxel) {
    for (const auto& [newtons, sum] : sums[taxel]) {
      const double rise = sum.first / sum.second;
      if (rise > kLeastSigmas * single.sigma[taxel]) taxel_[taxel].push_back({std::log(newtons), std::log(rise)});
    }
  }
  fit_sheet(taxel_);
  if (!any()) return;
  for (Points& points : taxel_) {
    for (auto& [log_newtons, log_siemens] : points) log_siemens -= of_sheet(log_newtons);
  }
}

/// Medians in bins of the force, the level of each taxel taken out.
void TaxelCurves::fit_sheet(const std::vector<Points>& measured) {
  std::vector<double> level(measured.size());
  for (int round = 0; round < kRounds; ++round) {
    std::map<int, std::pair<std::vector<double>, std::vector<double>>> bins;
    for (std::size_t taxel = 0; taxel < measured.size(); ++taxel) {
      for (const auto& [log_newtons, log_siemens] : measured[taxel]) {
        auto& [forces, values] = bins[static_cast<int>(std::floor(kBinsPerUnit * log_newtons))];
        forces.push_back(log_newtons);
        values.push_back(log_siemens - level[taxel]);
      }
    }
    sheet_.clear();
    for (auto& [bin, of_bin] : bins) {
      const double force = quantile(of_bin.first, 0.5);
      sheet_.push_back({force, quantile(std::move(of_bin.second), 0.5)});
    }
    if (!any()) return;
    for (std::size_t taxel = 0; taxel < measured.size(); ++taxel) {
      std::vector<double> above;
      for (const auto& [log_newtons, log_siemens] : measured[taxel]) {
        above.push_back(log_siemens - of_sheet(log_newtons));
      }
      if (!above.empty()) level[taxel] = quantile(std::move(above), 0.5);
    }
  }
}

double TaxelCurves::of_sheet(double log_newtons) const {
  const auto beyond = [&](const Point& end, const Point& inner) {
    const double slope = (inner.log_siemens - end.log_siemens) / (inner.log_newtons - end.log_newtons);
    return end.log_siemens + std::clamp(slope, kLeastSlope, kMostSlope) * (log_newtons - end.log_newtons);
  };
  if (log_newtons < sheet_.front().log_newtons) {
    auto inner = sheet_.begin() + 1;
    while (inner + 1 != sheet_.end() && inner->log_newtons - sheet_.front().log_newtons < kLeastSlopeSpan) ++inner;
    return beyond(sheet_.front(), *inner);
  }
  if (log_newtons > sheet_.back().log_newtons) return beyond(sheet_.back(), *(sheet_.end() - 2));
  return between(sheet_, log_newtons);
}

double TaxelCurves::siemens(std::size_t taxel, double newtons) const {
  if (!(newtons > 0.0)) return 0.0;
  const double log_newtons = std::log(newtons);
  const double own = taxel_[taxel].empty() ? 0.0 : between(taxel_[taxel], log_newtons);
  return std::exp(of_sheet(log_newtons) + own);
}

}  // namespace dermis::learn::calibration
