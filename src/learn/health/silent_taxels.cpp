// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/silent_taxels.hpp"

#include <algorithm>

#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/frames/touch.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::size_t kFewestFrames = 50;
constexpr double kFewCounts = 2.0;  // an untouched taxel may read them whatever it conducts
constexpr double kAsWeak = 1.25;    // times the unloaded conductance at most
constexpr std::size_t kFewestAsWeak = 3;
constexpr double kRead = 0.4;  // of the frames, the middle of those
constexpr double kWeak = 2.0;  // times, where there are too few of them
constexpr double kAlwaysRead = 0.95;

}  // namespace

SilentTaxels::SilentTaxels(const touch::pipeline::Model& model)
    : model_(model),
      zeros_(model.array.taxel_count()),
      silence_(model.array.taxel_count()),
      last_siemens_(model.array.taxel_count()),
      last_counts_(model.array.taxel_count()) {}

void SilentTaxels::add(const ConditionedFrame& conditioned, const ConductanceFrame& conductance) {
  const double counts = model_.array.readout.full_scale_counts();
  for (std::size_t taxel = 0; taxel < zeros_.size(); ++taxel) {
    const bool is_zero = conditioned.ratio[taxel] <= 0.0;
    zeros_[taxel] += is_zero ? 1 : 0;
    silence_[taxel] = is_zero ? silence_[taxel] + 1 : 0;
    if (is_zero) continue;
    last_siemens_[taxel] = conductance.siemens[taxel];
    last_counts_[taxel] = counts * conditioned.ratio[taxel];
  }
  ++frames_;
}

/// Rubber that was pressed may conduct less than untouched for a while.
bool SilentTaxels::is_silent(std::size_t taxel) const {
  const double unloaded = model_.networks.unloaded.offset_siemens[taxel];
  if (silence_[taxel] < kFewestFrames || !(unloaded > 0.0)) return false;
  return silence_[taxel] == frames_ || last_counts_[taxel] <= kFewCounts ||
         last_siemens_[taxel] <= kTouchedShare * unloaded;
}

bool SilentTaxels::others_read(std::size_t taxel) const {
  const std::vector<double>& unloaded = model_.networks.unloaded.offset_siemens;
  for (const double times : {kAsWeak, kWeak}) {
    std::vector<double> read;
    for (std::size_t other = 0; other < zeros_.size(); ++other) {
      const bool is_weak = unloaded[other] > 0.0 && unloaded[other] <= times * unloaded[taxel];
      if (!is_weak || silence_[other] >= kFewestFrames) continue;
      read.push_back(1.0 - static_cast<double>(zeros_[other]) / static_cast<double>(frames_));
    }
    if (read.size() >= kFewestAsWeak) return upper_median(read) >= (times == kAsWeak ? kRead : kAlwaysRead);
  }
  return false;
}

std::vector<bool> SilentTaxels::silent() const {
  std::vector<bool> silent(zeros_.size());
  for (std::size_t taxel = 0; taxel < silent.size(); ++taxel) silent[taxel] = is_silent(taxel) && others_read(taxel);
  return silent;
}

}  // namespace dermis::learn::health
