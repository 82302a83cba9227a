// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/force_sums.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis {
namespace {

using Region = std::span<const std::size_t>;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double square(double value) {
  return value * value;
}

double sum_of_squares(std::span<const double> values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

/// The total of a frame with forces and standard deviations alone: errors count as independent.
TotalForce independent_total(const ForceFrame& force, Region region) {
  TotalForce total;
  double variance = 0.0;
  for (const std::size_t taxel : region) {
    const double newtons = force.newtons[taxel];
    if (std::isnan(newtons)) {
      ++total.left_out;
      continue;
    }
    total.newtons += newtons;
    variance += square(force.sigma_newtons[taxel]);
  }
  total.sigma_newtons = std::sqrt(variance);
  return total;
}

/// Sums of forces as sums of conductances. Its memory is kept from call to call.
class ConductanceSums {
 public:
  void clear(std::span<const Region> regions) {
    const auto add_size = [](std::size_t sum, Region region) { return sum + region.size(); };
    const std::size_t taxels = std::accumulate(regions.begin(), regions.end(), std::size_t{0}, add_size);
    taxels_.clear();
    weight_.clear();
    sums_.clear();
    taxels_.reserve(taxels);  // sums_ points into them
    weight_.reserve(taxels);
  }
  void begin_sum() { sums_.push_back({{taxels_.data() + taxels_.size(), 0}, {weight_.data() + weight_.size(), 0}}); }
  void add(std::size_t taxel, double weight) {
    taxels_.push_back(taxel);
    weight_.push_back(weight);
    WeightedConductances& sum = sums_.back();
    sum = {{sum.taxels.data(), sum.taxels.size() + 1}, {sum.weight.data(), sum.weight.size() + 1}};
  }
  /// Variance of each sum.
  [[nodiscard]] std::span<const double> variances(const ConductanceErrors& errors) {
    variances_.assign(sums_.size(), 0.0);
    if (taxels_.empty()) return variances_;  // a rejected frame may have no conductances
    if (errors.circuit) {
      errors.circuit->variances(errors, sums_, variances_);
    } else if (!errors.noise_siemens.empty()) {
      for (std::size_t k = 0; k < sums_.size(); ++k) variances_[k] = independent_variance(errors, sums_[k]);
    }
    return variances_;
  }

 private:
  static double independent_variance(const ConductanceErrors& errors, const WeightedConductances& sum) {
    double variance = 0.0;
    for (std::size_t k = 0; k < sum.taxels.size(); ++k) {
      variance += square(sum.weight[k] * static_cast<double>(errors.noise_siemens[sum.taxels[k]]));
    }
    return variance;
  }

  std::vector<std::size_t> taxels_;
  std::vector<double> weight_;  // d total / d conductance
  std::vector<WeightedConductances> sums_;
  std::vector<double> variances_;
};

/// Without the errors of conductances.
TotalForce material_total(const ForceSums& sums, Region region, ConductanceSums& conductances) {
  TotalForce total;
  double variance = 0.0;
  double per_celsius = 0.0;
  conductances.begin_sum();
  for (const std::size_t taxel : region) {
    if (std::isnan(sums.newtons[taxel])) {
      ++total.left_out;
      continue;
    }
    total.newtons += static_cast<double>(sums.newtons[taxel]);
    variance += static_cast<double>(sums.own_variance[taxel]);
    per_celsius += static_cast<double>(sums.newtons_per_celsius[taxel]);
    conductances.add(taxel, static_cast<double>(sums.newtons_per_siemens[taxel]));
  }
  variance += square(per_celsius * sums.temperature_sigma) + square(sums.gain_sigma * total.newtons);
  if (sums.gains) variance += sums.gains->variance(sums.newtons, region);
  total.sigma_newtons = std::sqrt(variance);
  return total;
}

/// docs/reasons/derivations-forces.md, "Sums of forces".
void find_signed_totals(const ForceSums& sums, std::span<const Region> regions, std::span<TotalForce> totals) {
  thread_local ConductanceSums conductances;
  conductances.clear(regions);
  for (std::size_t k = 0; k < regions.size(); ++k) totals[k] = material_total(sums, regions[k], conductances);
  const std::span<const double> variances = conductances.variances(sums.conductances);
  for (std::size_t k = 0; k < regions.size(); ++k) {
    totals[k].sigma_newtons = std::sqrt(square(totals[k].sigma_newtons) + variances[k]);
  }
}

}  // namespace

double GainErrors::variance(std::span<const float> newtons, std::span<const std::size_t> taxels) const noexcept {
  thread_local std::vector<double> of_rows;
  thread_local std::vector<double> of_columns;
  of_rows.assign(sigma.size() / cols, 0.0);
  of_columns.assign(cols, 0.0);
  double of_sheet = 0.0;
  double own = 0.0;
  for (const std::size_t taxel : taxels) {
    if (std::isnan(newtons[taxel])) continue;
    const double shift = static_cast<double>(sigma[taxel]) * static_cast<double>(newtons[taxel]);
    of_rows[taxel / cols] += shift;
    of_columns[taxel % cols] += shift;
    of_sheet += shift;
    own += square(shift);
  }
  return sheet_share * square(of_sheet) + row_share * sum_of_squares(of_rows) +
         column_share * sum_of_squares(of_columns) + (1.0 - sheet_share - row_share - column_share) * own;
}

bool GainErrors::is_consistent(std::size_t taxels) const noexcept {
  if (sigma.empty()) return true;
  const auto is_sigma = [](float value) { return std::isfinite(value) && value >= 0.0F; };
  const double shared = sheet_share + row_share + column_share;
  return sigma.size() == taxels && std::all_of(sigma.begin(), sigma.end(), is_sigma) && cols > 0 &&
         taxels % cols == 0 && sheet_share >= 0.0 && row_share >= 0.0 && column_share >= 0.0 && shared <= 1.0;
}

TotalForce ForceFrame::total() const noexcept {
  thread_local std::vector<std::size_t> all;
  all.resize(newtons.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return total(all);
}

TotalForce ForceFrame::total(std::span<const std::size_t> taxels) const noexcept {
  TotalForce total;
  find_totals({&taxels, 1}, {&total, 1});
  return total;
}

void ForceFrame::find_totals(std::span<const std::span<const std::size_t>> regions,
                             std::span<TotalForce> totals) const noexcept {
  assert(totals.size() == regions.size());
  if (sums.newtons.empty()) {
    for (std::size_t k = 0; k < regions.size(); ++k) totals[k] = independent_total(*this, regions[k]);
  } else {
    find_signed_totals(sums, regions, totals);
  }
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (regions[k].empty() || totals[k].left_out < regions[k].size()) continue;
    totals[k].newtons = totals[k].sigma_newtons = kNothing;
  }
}

}  // namespace dermis
