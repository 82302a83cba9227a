// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "health/mute_taxels.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace dermis::health {
namespace {

constexpr std::size_t kFewestFrames = 50;
constexpr double kHighSigmas = 20.0;
constexpr double kNoiseThatShows = 0.7;  // counts; below it good readings repeat, too
constexpr std::size_t kMostShare = 8;    // one taxel in so many

}  // namespace

MuteTaxels::MuteTaxels(const pipeline::Model& model)
    : model_(model),
      forces_(model.array.taxel_count()),
      changes_(model.array.taxel_count()),
      counts_(model.array.taxel_count()),
      is_high_(model.array.taxel_count(), true),
      is_explained_(model.array.taxel_count()) {
  for (const std::size_t taxel : model.array.absent) is_explained_[taxel] = true;
  for (std::size_t taxel = 0; taxel < is_explained_.size(); ++taxel) {
    if (model.networks.dead[taxel] != 0) is_explained_[taxel] = true;
  }
}

void MuteTaxels::add(const RawFrame& raw, const ConditionedFrame& conditioned, const ForceFrame& force) {
  for (std::size_t taxel = 0; taxel < forces_.size(); ++taxel) {
    forces_[taxel] += std::isfinite(force.newtons[taxel]) ? 1 : 0;
    changes_[taxel] += frames_ > 0 && raw.counts[taxel] != counts_[taxel] ? 1 : 0;
    const bool is_missing = conditioned.taxels[taxel] == TaxelStatus::invalid;
    if (is_missing || force.taxels[taxel] == TaxelStatus::line_fault) is_explained_[taxel] = true;
    is_high_[taxel] = is_high_[taxel] && conditioned.ratio[taxel] > kHighSigmas * conditioned.sigma_ratio;
  }
  counts_ = raw.counts;
  ++frames_;
}

std::vector<std::string> MuteTaxels::findings() const {
  std::vector<std::string> found;
  if (frames_ < kFewestFrames) return found;
  const bool noise_shows = model_.array.readout.adc_noise_counts > kNoiseThatShows;
  for (std::size_t taxel = 0; taxel < forces_.size(); ++taxel) {
    if (is_explained_[taxel]) continue;
    const std::string name = model_.array.taxel_name(taxel);
    if (forces_[taxel] == 0) {
      found.push_back(fmt::format("taxel {} has a force in none of {} frames: check what it reads", name, frames_));
    } else if (noise_shows && is_high_[taxel] && changes_[taxel] == 0) {
      found.push_back(fmt::format("taxel {} reads {:g} counts in all {} frames: check the electronics that read it",
                                  name, counts_[taxel], frames_));
    }
  }
  if (found.size() > std::max<std::size_t>(forces_.size() / kMostShare, 1)) found.clear();
  return found;
}

}  // namespace dermis::health
