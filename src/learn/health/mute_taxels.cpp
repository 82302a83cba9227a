// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/mute_taxels.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace dermis::learn::health {
namespace {

constexpr std::size_t kFewestFrames = 50;
constexpr double kHighSigmas = 20.0;
constexpr double kNoiseThatShows = 0.7;  // counts; below it good readings repeat, too
constexpr std::size_t kMostNamed = 8;

}  // namespace

MuteTaxels::MuteTaxels(const touch::pipeline::Model& model)
    : model_(model),
      silent_(model),
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

void MuteTaxels::add(const RawFrame& raw, const ConditionedFrame& conditioned, const ConductanceFrame& conductance,
                     const ForceFrame& force) {
  silent_.add(conditioned, conductance);
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
  std::vector<bool> mute(forces_.size());
  std::vector<bool> fixed(forces_.size());
  std::vector<bool> silent = silent_.silent();
  for (std::size_t taxel = 0; taxel < forces_.size(); ++taxel) {
    if (is_explained_[taxel]) {
      silent[taxel] = false;
      continue;
    }
    mute[taxel] = forces_[taxel] == 0;
    fixed[taxel] = !mute[taxel] && noise_shows && is_high_[taxel] && changes_[taxel] == 0;
  }
  name(mute, fmt::format("no force in any of {} frames: check what is read there", frames_), found);
  name(fixed, fmt::format("the same high reading in all {} frames: check the electronics that read it", frames_),
       found);
  name(silent, "read 0 alone of late, while taxels as weak read more: check its wire, crimp and pin", found);
  return found;
}

/// Whole lines by one sentence each; taxels one by one where they are few.
void MuteTaxels::name(std::vector<bool> taxels, const std::string& what, std::vector<std::string>& found) const {
  const ArrayDescription& array = model_.array;
  const auto count = [&] { return static_cast<std::size_t>(std::count(taxels.begin(), taxels.end(), true)); };
  const bool is_most = 2 * count() > taxels.size();
  for (const Axis axis : kAxes) {
    for (std::size_t line = 0; line < line_count(array, axis) && !is_most; ++line) {
      if (!is_whole_line(taxels, axis, line)) continue;
      found.push_back(fmt::format("{} {} has {}", to_string(axis), line, what));
      for (std::size_t k = 0; k < line_length(array, axis); ++k) taxels[taxel_on_line(array, axis, line, k)] = false;
    }
  }
  if (count() > kMostNamed) {
    found.push_back(fmt::format("{} taxels have {}", count(), what));
    return;
  }
  for (std::size_t taxel = 0; taxel < taxels.size(); ++taxel) {
    if (taxels[taxel]) found.push_back(fmt::format("taxel {} has {}", array.taxel_name(taxel), what));
  }
}

/// But for taxels that something else explains.
bool MuteTaxels::is_whole_line(const std::vector<bool>& taxels, Axis axis, std::size_t line) const {
  std::size_t count = 0;
  for (std::size_t k = 0; k < line_length(model_.array, axis); ++k) {
    const std::size_t taxel = taxel_on_line(model_.array, axis, line, k);
    if (!taxels[taxel] && !is_explained_[taxel]) return false;
    count += taxels[taxel] ? 1 : 0;
  }
  return 2 * count > line_length(model_.array, axis);
}

}  // namespace dermis::learn::health
