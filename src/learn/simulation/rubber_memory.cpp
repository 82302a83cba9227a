// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/rubber_memory.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

#include "learn/simulation/option_range.hpp"

namespace dermis::learn::simulation {
namespace {

constexpr std::size_t kElements = std::size(RubberMemory::kCreepSeconds);
constexpr std::size_t kStops = std::size(RubberMemory::kStopReach);
constexpr double kReferenceSeconds = 1.0;  // After so long, a held load is felt as it is.

/// E(t): how many decades of creep have passed.
double crept_decades(double seconds) {
  double decades = 0.0;
  for (const double tau : RubberMemory::kCreepSeconds) decades -= std::expm1(-seconds / tau);
  return decades;
}

double closed_share(double load_n) {
  return -std::expm1(-load_n / RubberMemory::kClosingN);
}

}  // namespace

Status RubberMemoryOptions::validate() const {
  return check_ranges({{"rubber.creep_per_decade", creep_per_decade, 0.02, 0.30},
                       {"rubber.loop_gap", loop_gap, 0.0, 0.2},
                       {"rubber.touch_gain", touch_gain, 0.0, 0.3},
                       {"rubber.release_dip", release_dip, 0.0, 0.6}});
}

RubberMemory::RubberMemory(const RubberMemoryOptions& options, std::size_t taxels, std::uint64_t seed)
    : options_(options),
      instant_share_(1.0 - options.creep_per_decade * crept_decades(kReferenceSeconds)),
      load_n_(taxels),
      creep_n_(kElements * taxels),
      stops_(kStops * taxels),
      gain_(taxels, 1.0),
      touches_(seed) {}

void RubberMemory::press(std::span<const double> load_n, double seconds) {
  assert(load_n.size() == load_n_.size() && seconds >= 0.0);
  for (std::size_t i = 0; i < load_n.size(); ++i) {
    if (load_n[i] != load_n_[i]) change_load(i, load_n[i]);
  }
  creep(seconds);
}

void RubberMemory::change_load(std::size_t taxel, double load_n) {
  if (load_n_[taxel] == 0.0 && options_.touch_gain > 0.0) {
    gain_[taxel] = std::exp(options_.touch_gain * touches_.normal());
  }
  const double change = std::log1p(load_n) - std::log1p(load_n_[taxel]);
  for (std::size_t j = 0; j < kStops; ++j) {
    double& stop = stops_[taxel * kStops + j];
    stop = std::clamp(stop + change / kStopReach[j], -1.0, 1.0);
  }
  load_n_[taxel] = load_n;
}

void RubberMemory::creep(double seconds) {
  for (std::size_t k = 0; k < kElements; ++k) {
    const double approach = -std::expm1(-seconds / kCreepSeconds[k]);
    double* const late_n = creep_n_.data() + k * load_n_.size();
    for (std::size_t i = 0; i < load_n_.size(); ++i) late_n[i] += (load_n_[i] - late_n[i]) * approach;
  }
}

/// z, in newtons.
double RubberMemory::late_compression(std::size_t taxel) const {
  double sum_n = 0.0;
  for (std::size_t k = 0; k < kElements; ++k) sum_n += creep_n_[k * load_n_.size() + taxel];
  return sum_n;
}

double RubberMemory::material_force(std::size_t taxel) const {
  const double load_n = load_n_[taxel];
  if (load_n == 0.0) return 0.0;
  const double compression_n = load_n * instant_share_ + options_.creep_per_decade * late_compression(taxel);
  double friction = 0.0;
  for (std::size_t j = 0; j < kStops; ++j) friction += stops_[taxel * kStops + j];
  friction *= options_.loop_gap / (2.0 * static_cast<double>(kStops));
  return closed_share(load_n) * gain_[taxel] * compression_n * (1.0 - friction);
}

double RubberMemory::unloaded_share(std::size_t taxel) const {
  const double late_n = late_compression(taxel);
  return 1.0 - options_.release_dip * (1.0 - closed_share(load_n_[taxel])) * late_n / (late_n + kSetN);
}

}  // namespace dermis::learn::simulation
