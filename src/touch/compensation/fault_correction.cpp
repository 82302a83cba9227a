// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Defect correction, in FaultInversion: from the healthy circuit to that with faults.
#include <algorithm>
#include <cmath>
#include <limits>

#include "touch/compensation/fault_inversion.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kMostStretch = 5.0;

}  // namespace

/// The correction of the last frame.
void FaultInversion::start_circuits() noexcept {
  if (!correction_.has_shift) return missing_.estimate(equivalent_);
  for (std::size_t taxel = 0; taxel < equivalent_.size(); ++taxel) equivalent_[taxel] += correction_.shift[taxel];
}

void FaultInversion::keep_shift() noexcept {
  correction_.has_shift = true;
  for (std::size_t taxel = 0; taxel < equivalent_.size(); ++taxel) {
    const double shift = equivalent_[taxel] - measured_[taxel];
    correction_.shift[taxel] = std::isfinite(shift) ? shift : 0.0;
  }
}

void FaultInversion::solve_circuits(std::span<const double> siemens) noexcept {
  film_.follow(siemens);
  for (LumpedCircuit* const circuit : {&circuits_->healthy, &circuits_->faulty}) {
    if (film_.any()) circuit->set_film(film_.film());
  }
  circuits_->healthy.solve(siemens, correction_.healthy_ratio);
  circuits_->faulty.solve(siemens, correction_.faulty_ratio);
}

/// T' from both circuits at the present conductances; how far it is from the T' that led to them. The step is
/// Anderson's of depth 1: along the last change of T' as far as makes the difference smallest, were it linear.
double FaultInversion::correct(bool first) noexcept {
  if (!crossings_.are_corrected) {  // their readings stay what they are
    for (const std::size_t taxel : crossings_.taxels) {
      correction_.healthy_ratio[taxel] = equivalent_[taxel];
      correction_.faulty_ratio[taxel] = measured_[taxel];
    }
  }
  double change = 0.0;
  double sum = 0.0;  // not a number where any difference is none; max() would drop it
  double along = 0.0;
  double square = 0.0;
  for (std::size_t taxel = 0; taxel < equivalent_.size(); ++taxel) {
    const double known = missing_.is_missing(taxel) ? 0.0 : measured_[taxel] - correction_.faulty_ratio[taxel];
    const bool is_kept = std::isnan(equivalent_[taxel]);
    const double difference = is_kept ? 0.0 : correction_.healthy_ratio[taxel] + known - equivalent_[taxel];
    change = std::max(change, std::abs(difference));
    sum += difference;
    const double turn = difference - correction_.last_difference[taxel];
    along += difference * turn;
    square += turn * turn;
    correction_.difference[taxel] = difference;
  }
  if (mixing_ && std::isfinite(sum)) {
    mix(first);
    return change;
  }
  const double share = first || square == 0.0 ? 0.0 : std::clamp(along / square, -kMostStretch, kMostStretch);
  for (std::size_t taxel = 0; taxel < equivalent_.size(); ++taxel) {
    const double corrected = equivalent_[taxel] + correction_.difference[taxel];
    equivalent_[taxel] = corrected - share * (corrected - correction_.last_corrected[taxel]);
    correction_.last_corrected[taxel] = corrected;
    correction_.last_difference[taxel] = correction_.difference[taxel];
  }
  return std::isfinite(sum) ? change : std::numeric_limits<double>::infinity();
}

/// A film couples all lines, so that the last change alone does not tell the way.
void FaultInversion::mix(bool first) noexcept {
  if (first) mixing_->forget();
  std::vector<double>& next = correction_.last_corrected;
  for (std::size_t taxel = 0; taxel < next.size(); ++taxel) {
    next[taxel] = std::isnan(equivalent_[taxel]) ? 0.0 : equivalent_[taxel];
  }
  mixing_->advance(next, correction_.difference);
  for (std::size_t taxel = 0; taxel < next.size(); ++taxel) {
    if (!std::isnan(equivalent_[taxel])) equivalent_[taxel] = next[taxel];
  }
}

double FaultInversion::misfit(std::span<const double> siemens) const noexcept {
  double largest = 0.0;
  for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
    if (missing_.is_missing(taxel)) continue;
    const double difference = measured_[taxel] - correction_.faulty_ratio[taxel];
    if (siemens[taxel] == 0.0 && difference < 0.0) continue;
    largest = std::max(largest, std::abs(difference));
  }
  return largest;
}

}  // namespace dermis::touch::compensation
