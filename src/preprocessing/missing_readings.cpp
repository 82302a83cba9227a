// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/preprocessing/missing_readings.hpp"

#include <algorithm>

namespace dermis::preprocessing {

void MissingReadings::add(const ConditionedFrame& conditioned) noexcept {
  if (has(conditioned.status, FrameStatus::rejected)) return;
  ++frames_;
  for (std::size_t taxel = 0; taxel < missing_.size(); ++taxel) {
    missing_[taxel] += conditioned.taxels[taxel] == TaxelStatus::invalid ? 1 : 0;
  }
  for (const std::size_t taxel : array_.absent) missing_[taxel] = 0;
}

bool MissingReadings::any() const noexcept {
  return std::any_of(missing_.begin(), missing_.end(), [](std::size_t frames) { return frames > 0; });
}

std::string MissingReadings::describe() const {
  constexpr std::size_t kMostNames = 5;
  std::vector<std::size_t> taxels;
  for (std::size_t taxel = 0; taxel < missing_.size(); ++taxel) {
    if (missing_[taxel] > 0) taxels.push_back(taxel);
  }
  std::stable_sort(taxels.begin(), taxels.end(),
                   [&](std::size_t a, std::size_t b) { return missing_[a] > missing_[b]; });
  std::string text = "no reading (not a number, or outside the ADC) of ";
  const std::size_t named = std::min(taxels.size(), kMostNames);
  for (std::size_t k = 0; k < named; ++k) {
    if (k > 0) text += ", ";
    text += array_.taxel_name(taxels[k]) + " in " + std::to_string(missing_[taxels[k]]);
  }
  text += " of " + std::to_string(frames_) + " frames";
  if (taxels.size() > named) text += ", and of " + std::to_string(taxels.size() - named) + " more taxels";
  return text;
}

}  // namespace dermis::preprocessing
