// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/missing_readings.hpp"

#include <algorithm>
#include <cmath>

#include "dermis/touch/frames/number_text.hpp"

namespace dermis::touch::preprocessing {

bool MissingReadings::add(const RawFrame& raw, const ConditionedFrame& conditioned) noexcept {
  const bool is_outside = add_range(raw);
  if (is_outside) ++frames_outside_;
  if (has(conditioned.status, FrameStatus::rejected)) return is_outside;
  ++frames_;
  for (std::size_t taxel = 0; taxel < missing_.size(); ++taxel) {
    missing_[taxel] += conditioned.taxels[taxel] == TaxelStatus::invalid ? 1 : 0;
  }
  for (const std::size_t taxel : array_.absent) missing_[taxel] = 0;
  return is_outside;
}

/// Whether some readings are none of the ADC.
bool MissingReadings::add_range(const RawFrame& raw) noexcept {
  if (array_.readout.quantity != Quantity::counts) return false;
  const auto full_scale = static_cast<float>(array_.readout.full_scale_counts());
  bool is_outside = false;
  for (std::size_t taxel = 0; taxel < std::min(raw.counts.size(), missing_.size()); ++taxel) {
    const float count = raw.counts[taxel];
    if (!std::isfinite(count) || array_.is_absent(taxel)) continue;
    least_counts_ = std::min(least_counts_, count);
    most_counts_ = std::max(most_counts_, count);
    is_outside = is_outside || count < 0.0F || count > full_scale;
  }
  return is_outside;
}

bool MissingReadings::any() const noexcept {
  return std::any_of(missing_.begin(), missing_.end(), [](std::size_t frames) { return frames > 0; });
}

std::optional<std::string> MissingReadings::describe_range() const {
  if (frames_outside_ == 0) return std::nullopt;
  return "readings of " + shortest_text(least_counts_) + " to " + shortest_text(most_counts_) +
         ", but the ADC gives 0 to " + std::to_string(std::llround(array_.readout.full_scale_counts())) +
         " (adc_bits = " + std::to_string(array_.readout.adc_bits) + ")";
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

}  // namespace dermis::touch::preprocessing
