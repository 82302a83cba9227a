// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/core/force_sums.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "dermis/core/frames.hpp"

namespace dermis {
namespace {

/// Every taxel is in it, or those of a list.
class Region {
 public:
  explicit Region(std::size_t taxels) : size_(taxels) {}
  explicit Region(std::span<const std::size_t> taxels) : taxels_(taxels.data()), size_(taxels.size()) {}

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::size_t operator[](std::size_t k) const noexcept { return taxels_ == nullptr ? k : taxels_[k]; }

 private:
  const std::size_t* taxels_ = nullptr;
  std::size_t size_;
};

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double square(double value) {
  return value * value;
}

/// Of a frame that tells forces and standard deviations alone: errors count as independent.
TotalForce independent_total(const ForceFrame& force, const Region& region) {
  TotalForce total;
  double variance = 0.0;
  for (std::size_t k = 0; k < region.size(); ++k) {
    const double newtons = force.newtons[region[k]];
    if (std::isnan(newtons)) {
      ++total.left_out;
      continue;
    }
    total.newtons += newtons;
    variance += square(force.sigma_newtons[region[k]]);
  }
  total.sigma_newtons = std::sqrt(variance);
  return total;
}

double conductance_variance(const ConductanceErrors& errors, std::span<const double> weight) {
  if (errors.circuit) return errors.circuit->variance(errors, weight);
  double variance = 0.0;
  for (std::size_t taxel = 0; taxel < errors.noise_siemens.size(); ++taxel) {
    variance += square(weight[taxel] * static_cast<double>(errors.noise_siemens[taxel]));
  }
  return variance;
}

/// docs/derivations.md, "Sums of forces".
TotalForce signed_total(const ForceSums& sums, const Region& region) {
  thread_local std::vector<double> weight;  // d total / d conductance
  weight.assign(sums.newtons.size(), 0.0);
  TotalForce total;
  double variance = 0.0;
  double per_celsius = 0.0;
  for (std::size_t k = 0; k < region.size(); ++k) {
    const std::size_t taxel = region[k];
    if (std::isnan(sums.newtons[taxel])) {
      ++total.left_out;
      continue;
    }
    total.newtons += static_cast<double>(sums.newtons[taxel]);
    variance += static_cast<double>(sums.own_variance[taxel]);
    per_celsius += static_cast<double>(sums.newtons_per_celsius[taxel]);
    weight[taxel] = static_cast<double>(sums.newtons_per_siemens[taxel]);
  }
  if (total.left_out == region.size()) return total;  // a rejected frame may have no conductances
  variance += square(per_celsius * sums.temperature_sigma) + square(sums.gain_sigma * total.newtons);
  variance += conductance_variance(sums.conductances, weight);
  total.sigma_newtons = std::sqrt(variance);
  return total;
}

TotalForce total_of(const ForceFrame& force, const Region& region) {
  TotalForce total = force.sums.newtons.empty() ? independent_total(force, region) : signed_total(force.sums, region);
  if (region.size() > 0 && total.left_out == region.size()) total.newtons = total.sigma_newtons = kNothing;
  return total;
}

}  // namespace

TotalForce ForceFrame::total() const noexcept {
  return total_of(*this, Region(newtons.size()));
}

TotalForce ForceFrame::total(std::span<const std::size_t> taxels) const noexcept {
  return total_of(*this, Region(taxels));
}

}  // namespace dermis
