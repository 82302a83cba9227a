// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/sheet/cover_shares.hpp"

#include <algorithm>
#include <cmath>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kLeastShare = 1e-6;
constexpr double kMostShare = 2.0;
constexpr int kHalvings = 20;
constexpr double kSigmasOfMedian = 1.2533;  // standard error of a median over that of a mean
constexpr double kSigmasOfDeviation = 1.4826;
constexpr double kAgreeingErrors = 6.0;

double median(const std::vector<double>& values) {
  return 0.5 * (quantile(values, 0.5) + upper_median(values));
}

double deviation(std::vector<double> values, double level) {
  for (double& value : values) value = std::abs(value - level);
  return kSigmasOfDeviation * quantile(std::move(values), 0.5);
}

/// The middle of the directions, or the lesser of two that differ by more than chance: what was pressed just before has
/// not recovered yet.
double middle(std::vector<double> shares, double error) {
  std::sort(shares.begin(), shares.end());
  if (shares.size() == 2 && shares[1] - shares[0] > kAgreeingErrors * error) return shares[0];
  return median(shares);
}

}  // namespace

CoverShares::CoverShares(const ArrayDescription& array, const SinglePresses& single, const TaxelCurves& curves)
    : array_(array), single_(single), curves_(curves) {
  const std::vector<SinglePress>& presses = single.presses;
  for (std::size_t k = 0; k < presses.size(); ++k) {
    if (k == 0 || presses[k].taxel != presses[k - 1].taxel) places_.push_back({k, k});
    places_.back().last = k + 1;
  }
}

/// All presses of one taxel together: the share with which the other one's curve gives the sum of its rises.
double CoverShares::of_pair(const Place& pressed, std::size_t beside) const {
  double rise = 0.0;
  for (std::size_t k = pressed.first; k < pressed.last; ++k) {
    rise += curves_.at_middle(single_.presses[k].rise[beside], single_.presses[k].temperature);
  }
  if (!(rise > 0.0)) return 0.0;
  double low = std::log(kLeastShare);
  double high = std::log(kMostShare);
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double share = 0.5 * (low + high);
    double sum = 0.0;
    for (std::size_t k = pressed.first; k < pressed.last; ++k) {
      sum += curves_.siemens(beside, std::exp(share) * single_.presses[k].newtons);
    }
    (sum < rise ? low : high) = share;
  }
  return std::exp(low);
}

std::vector<double> CoverShares::of_direction(std::ptrdiff_t rows, std::ptrdiff_t cols) const {
  std::vector<double> shares;
  const auto is_inside = [](std::ptrdiff_t line, std::size_t lines) {
    return line >= 0 && line < static_cast<std::ptrdiff_t>(lines);
  };
  for (const Place& place : places_) {
    const std::size_t taxel = single_.presses[place.first].taxel;
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(taxel / array_.cols) + rows;
    const std::ptrdiff_t col = static_cast<std::ptrdiff_t>(taxel % array_.cols) + cols;
    if (!is_inside(row, array_.rows) || !is_inside(col, array_.cols)) continue;
    const std::size_t beside = array_.index(static_cast<std::size_t>(row), static_cast<std::size_t>(col));
    if (!array_.is_absent(beside)) shares.push_back(of_pair(place, beside));
  }
  return shares;
}

RelativeShare CoverShares::at(std::size_t rows, std::size_t cols) const {
  std::vector<double> all;
  std::vector<double> directions;
  const auto down = static_cast<std::ptrdiff_t>(rows);
  const auto right = static_cast<std::ptrdiff_t>(cols);
  for (const std::ptrdiff_t row : rows > 0 ? std::vector{down, -down} : std::vector{down}) {
    for (const std::ptrdiff_t col : cols > 0 ? std::vector{right, -right} : std::vector{right}) {
      const std::vector<double> shares = of_direction(row, col);
      if (shares.empty()) continue;
      directions.push_back(median(shares));
      all.insert(all.end(), shares.begin(), shares.end());
    }
  }
  RelativeShare found;
  if (all.empty()) return found;
  found.pairs = all.size();
  const double scatter = deviation(all, median(all));
  found.error = kSigmasOfMedian * scatter / std::sqrt(static_cast<double>(all.size()));
  found.least = *std::min_element(directions.begin(), directions.end());
  found.share = middle(std::move(directions), found.error);
  found.scatter = found.share > 0.0 ? scatter / found.share : 1.0;
  return found;
}

}  // namespace dermis::learn::calibration
