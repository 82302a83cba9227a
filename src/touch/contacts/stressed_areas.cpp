// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/stressed_areas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::contacts {
namespace {

constexpr std::int32_t kNone = -1;

/// Nothing is pressed here, and all taxels have a force.
template <std::size_t Taxels>
bool is_idle(const float* signal_to_noise, float sigma) {
  std::uint32_t other = 0;
  for (std::size_t k = 0; k < Taxels; ++k) other |= static_cast<std::uint32_t>(!(signal_to_noise[k] < sigma));
  return other == 0;
}

}  // namespace

StressedAreas::StressedAreas(std::size_t rows, std::size_t cols, bool overlapping)
    : rows_(rows), cols_(cols), overlapping_(overlapping), order_at_((rows + 2) * (cols + 2), kNone) {
  const std::size_t taxels = rows * cols;
  pressed_.reserve(taxels);
  peaks_.reserve(taxels);
  taxels_.reserve(taxels);
  areas_.reserve(taxels);
}

void StressedAreas::find(const ForceFrame& force, double sigma, std::span<const std::uint32_t> held) {
  collect(force, static_cast<float>(sigma));
  std::sort(pressed_.begin(), pressed_.end(), [](const Pressed& a, const Pressed& b) {
    return a.newtons != b.newtons ? a.newtons > b.newtons : a.taxel < b.taxel;
  });
  grow(held);
  group();
}

DERMIS_PROCESSOR_CLONES void StressedAreas::collect(const ForceFrame& force, float sigma) {
  constexpr std::size_t kBlock = 16;
  pressed_.clear();
  const std::size_t taxels = rows_ * cols_;
  for (std::size_t first = 0; first < taxels; first += kBlock) {
    const std::size_t end = std::min(first + kBlock, taxels);
    if (end == first + kBlock && is_idle<kBlock>(&force.signal_to_noise[first], sigma)) continue;
    for (std::size_t taxel = first; taxel < end; ++taxel) collect_one(force, taxel, sigma);
  }
}

void StressedAreas::collect_one(const ForceFrame& force, std::size_t taxel, float sigma) {
  if (force.signal_to_noise[taxel] < sigma) return;
  const float newtons = force.newtons[taxel];
  const float noise = force.sigma_newtons[taxel];
  const bool has_force = !std::isnan(newtons);
  const float value = has_force ? newtons : bridged_newtons(force, taxel);
  if (value <= 0.0F) return;
  const float signal = has_force ? force.signal_to_noise[taxel] : 0.0F;
  pressed_.push_back(
      {value, std::isfinite(noise) ? noise : 0.0F, signal, static_cast<std::uint32_t>(taxel), 0, has_force});
}

float StressedAreas::bridged_newtons(const ForceFrame& force, std::size_t taxel) const noexcept {
  const std::size_t row = taxel / cols_;
  const std::size_t col = taxel % cols_;
  const bool between_rows = row > 0 && row + 1 < rows_;
  const bool between_cols = col > 0 && col + 1 < cols_;
  const auto lower = [&](bool exists, std::size_t step) {
    if (!exists) return 0.0F;
    const float newtons = std::min(force.newtons[taxel - step], force.newtons[taxel + step]);
    return std::isnan(newtons) || std::isnan(force.newtons[taxel + step]) ? 0.0F : newtons;
  };
  return std::max({lower(between_rows, cols_), lower(between_cols, 1), lower(between_rows && between_cols, cols_ + 1),
                   lower(between_rows && between_cols, cols_ - 1)});
}

void StressedAreas::grow(std::span<const std::uint32_t> held) {
  peaks_.clear();
  const std::size_t width = cols_ + 2;
  const std::array<std::size_t, 8> corners{0, 1, 2, width, width + 2, 2 * width, 2 * width + 1, 2 * width + 2};
  for (std::size_t k = 0; k < pressed_.size(); ++k) {
    Pressed& pressed = pressed_[k];
    const std::size_t first = place(pressed.taxel) - width - 1;
    std::int32_t strongest = kNone;
    for (const std::size_t corner : corners) {
      const std::int32_t other = order_at_[first + corner];
      if (other == kNone) continue;
      if (strongest != kNone) {
        meet(pressed_[static_cast<std::size_t>(strongest)].peak, pressed_[static_cast<std::size_t>(other)].peak,
             pressed);
      }
      strongest = strongest == kNone ? other : std::min(strongest, other);
    }
    if (strongest != kNone) {
      pressed.peak = pressed_[static_cast<std::size_t>(strongest)].peak;
    } else if (pressed.has_force) {
      begin_area(pressed, held);
    } else {
      continue;
    }
    order_at_[place(pressed.taxel)] = static_cast<std::int32_t>(k);
  }
}

void StressedAreas::begin_area(Pressed& pressed, std::span<const std::uint32_t> held) {
  pressed.peak = static_cast<std::int32_t>(peaks_.size());
  peaks_.push_back({pressed.newtons, pressed.sigma, pressed.signal, pressed.peak, nearest(pressed.taxel, held), 0, 0});
}

void StressedAreas::meet(std::int32_t a, std::int32_t b, const Pressed& valley) {
  std::int32_t higher = top(a);
  std::int32_t lower = top(b);
  if (higher == lower) return;
  if (lower < higher) std::swap(higher, lower);  // by falling force
  const Peak& high = peaks_[static_cast<std::size_t>(higher)];
  Peak& low = peaks_[static_cast<std::size_t>(lower)];
  const bool are_held = high.held != kNone && low.held != kNone && high.held != low.held;
  const float scale = are_held ? kHeldShare : 1.0F;
  const float depth = low.newtons - valley.newtons;
  const float noise = std::sqrt(low.sigma * low.sigma + valley.sigma * valley.sigma);
  const bool is_valley = depth >= scale * kValleySigma * noise && depth >= scale * kValleyShare * low.newtons &&
                         valley.signal < low.signal;
  if (overlapping_ || !is_valley) low.higher = higher;
}

void StressedAreas::group() {
  areas_.clear();
  taxels_.clear();
  for (Pressed& pressed : pressed_) {
    order_at_[place(pressed.taxel)] = kNone;
    if (!pressed.has_force) continue;
    pressed.peak = top(pressed.peak);
    ++peaks_[static_cast<std::size_t>(pressed.peak)].count;
  }
  std::uint32_t first = 0;
  for (Peak& peak : peaks_) {
    peak.first = first;
    first += peak.count;
    peak.count = 0;
  }
  taxels_.resize(first);
  for (const Pressed& pressed : pressed_) {
    if (!pressed.has_force) continue;
    Peak& peak = peaks_[static_cast<std::size_t>(pressed.peak)];
    taxels_[peak.first + peak.count++] = pressed.taxel;
  }
  for (const Peak& peak : peaks_) {
    if (peak.count > 0) areas_.emplace_back(taxels_.data() + peak.first, peak.count);
  }
}

std::int32_t StressedAreas::top(std::int32_t peak) const noexcept {
  while (peaks_[static_cast<std::size_t>(peak)].higher != peak) peak = peaks_[static_cast<std::size_t>(peak)].higher;
  return peak;
}

std::int32_t StressedAreas::nearest(std::uint32_t taxel, std::span<const std::uint32_t> held) const noexcept {
  const auto row = static_cast<std::int64_t>(taxel / cols_);
  const auto col = static_cast<std::int64_t>(taxel % cols_);
  std::int32_t found = kNone;
  std::int64_t least = 3;  // of the squared distance: the 8 neighbours are at 1 or 2
  for (std::size_t k = 0; k < held.size(); ++k) {
    const std::int64_t down = static_cast<std::int64_t>(held[k] / cols_) - row;
    const std::int64_t across = static_cast<std::int64_t>(held[k] % cols_) - col;
    const std::int64_t distance = down * down + across * across;
    if (distance >= least) continue;
    least = distance;
    found = static_cast<std::int32_t>(k);
  }
  return found;
}

}  // namespace dermis::touch::contacts
