// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/spikes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "compensation/readout_parts.hpp"
#include "dermis/core/processor_clones.hpp"

namespace dermis::compensation {
namespace {

constexpr Nanos kLongestGap = std::chrono::milliseconds(50);
constexpr double kLeastJump = 0.05;  // of the supply
constexpr double kLoadedSigmas = 20.0;
constexpr double kMostChange = 0.3;   // of a load that is about what it was
constexpr double kMostChanged = 0.4;  // of the loads; else the frame is not compared with the last
constexpr std::size_t kNear = 2;      // places: a press reaches them
constexpr double kLeastFall = 0.05;   // of the others' readings
constexpr double kSeenSigmas = 6.0;   // of a fall of one reading, or of all small ones together
constexpr double kSeenTogether = 5.0;
constexpr double kMoreStay = 2.0;    // than fall
constexpr double kNewShare = 0.125;  // of a reading in its mean
constexpr double kLeastLeft = 0.01;  // of the supply
constexpr std::uint8_t kMostFrames = 3;
constexpr std::size_t kAtOnce = 8;  // sums that do not wait for each other

}  // namespace

Spikes::Spikes(const ArrayDescription& array)
    : cols_(array.cols),
      axis_(sharing_axis(array).value_or(Axis::column)),
      lines_(line_count(array, axis_)),
      places_(line_length(array, axis_)),
      last_(array.taxel_count()),
      change_(array.taxel_count()),
      jumped_(array.taxel_count()),
      frames_(array.taxel_count()),
      stale_(array.taxel_count()) {
  if (!sharing_axis(array)) return;
  taken_.assign(array.taxel_count(), 1.0);
  if (array.readout.circuit != Circuit::transimpedance) return;
  for (std::size_t taxel = 0; taxel < taken_.size(); ++taxel) {
    taken_[taxel] = array.readout.drive_ohm[taxel / cols_] / array.readout.load_ohm[taxel % cols_];
  }
}

void Spikes::check(const ConditionedFrame& frame, std::span<TaxelStatus> taxels) noexcept {
  if (taken_.empty()) return;
  const std::span<const double> ratio = frame.ratio;
  const Nanos since_last = frame.time - last_time_;
  last_time_ = frame.time;
  if (!has_last_ || since_last > kLongestGap || since_last < Nanos{0}) {
    std::copy(ratio.begin(), ratio.end(), last_.begin());
    std::fill(jumped_.begin(), jumped_.end(), 0.0);
    for (std::vector<std::uint8_t>* const of_last : {&frames_, &stale_}) {
      std::fill(of_last->begin(), of_last->end(), std::uint8_t{0});
    }
    has_last_ = true;
    any_stale_ = false;
    return;
  }
  renew(ratio, taxels);
  const bool is_checked = any_jump(ratio) && follows_last(ratio, frame.sigma_ratio);
  for (std::size_t line = 0; line < lines_ && is_checked; ++line) check_line(line, ratio, frame.sigma_ratio, taxels);
  follow(ratio, frame.sigma_ratio, taxels);
}

/// A taxel without a reading in the last frame is not compared with an older one: others have changed since.
void Spikes::renew(std::span<const double> ratio, std::span<const TaxelStatus> taxels) noexcept {
  const bool all_are_read = std::find(taxels.begin(), taxels.end(), TaxelStatus::invalid) == taxels.end();
  if (all_are_read && !std::exchange(any_stale_, false)) return;
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    const bool is_reading = taxels[taxel] != TaxelStatus::invalid;
    if (is_reading && stale_[taxel] != 0) last_[taxel] = ratio[taxel];
    stale_[taxel] = is_reading ? 0 : 1;
  }
  any_stale_ = !all_are_read;
}

/// The mean of readings that change by no more than noise, without those that are not believed.
DERMIS_PROCESSOR_CLONES void Spikes::follow(std::span<const double> ratio, double sigma_ratio,
                                            std::span<const TaxelStatus> taxels) noexcept {
  const double noise = kSeenSigmas * sigma_ratio;
  const auto is_reading = [&](std::size_t taxel) { return taxels[taxel] != TaxelStatus::invalid; };
  const bool all_are_read = std::find(taxels.begin(), taxels.end(), TaxelStatus::invalid) == taxels.end();
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) change_[taxel] = ratio[taxel] - last_[taxel];
  for (std::size_t taxel = 0; taxel < ratio.size() && !all_are_read; ++taxel) {
    if (!is_reading(taxel)) change_[taxel] = 0.0;
  }
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    const double change = change_[taxel];
    const double little = kNewShare * change;
    last_[taxel] += std::abs(change) > noise ? change : little;
  }
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) jumped_[taxel] = change_[taxel] > kLeastJump ? 1.0 : 0.0;
  std::transform(frames_.begin(), frames_.end(), taxels.begin(), frames_.begin(),
                 [](std::uint8_t frames, TaxelStatus status) -> std::uint8_t {
                   return status == TaxelStatus::invalid ? frames : 0;
                 });
}

DERMIS_PROCESSOR_CLONES bool Spikes::any_jump(std::span<const double> ratio) const noexcept {
  double most[kAtOnce] = {};
  std::size_t taxel = 0;
  for (; taxel + kAtOnce <= ratio.size(); taxel += kAtOnce) {
    for (std::size_t k = 0; k < kAtOnce; ++k) {
      const double change = ratio[taxel + k] - last_[taxel + k];
      most[k] = change > most[k] ? change : most[k];
    }
  }
  for (; taxel < ratio.size(); ++taxel) most[0] = std::max(most[0], ratio[taxel] - last_[taxel]);
  return *std::max_element(most, most + kAtOnce) > kLeastJump;
}

/// Most of the loads are about what they were, those that have just jumped aside: they may fall back. Where there are
/// no others, there is no evidence.
DERMIS_PROCESSOR_CLONES bool Spikes::follows_last(std::span<const double> ratio, double sigma_ratio) const noexcept {
  double loads[kAtOnce] = {};
  double changed[kAtOnce] = {};
  double jumped[kAtOnce] = {};
  const double least = kLoadedSigmas * sigma_ratio;
  const auto add = [&](std::size_t taxel, std::size_t k) {
    const double last = last_[taxel];
    const double load = last > least ? last : 0.0;
    const double falls = jumped_[taxel] * load;
    const double stays = load - falls;
    jumped[k] += falls;
    loads[k] += stays;
    changed[k] += std::abs(ratio[taxel] - last) > kMostChange * last ? stays : 0.0;
  };
  std::size_t taxel = 0;
  for (; taxel + kAtOnce <= ratio.size(); taxel += kAtOnce) {
    for (std::size_t k = 0; k < kAtOnce; ++k) add(taxel + k, k);
  }
  for (std::size_t k = 0; taxel + k < ratio.size(); ++k) add(taxel + k, k);
  const auto sum = [](const double(&parts)[kAtOnce]) { return std::accumulate(parts, parts + kAtOnce, 0.0); };
  return sum(changed) <= kMostChanged * sum(loads) && (sum(loads) > 0.0 || sum(jumped) == 0.0);
}

void Spikes::check_line(std::size_t line, std::span<const double> ratio, double sigma_ratio,
                        std::span<TaxelStatus> taxels) noexcept {
  double before = 0.0;
  double now = 0.0;
  std::size_t jumping = places_;
  double jump = kLeastJump;
  for (std::size_t place = 0; place < places_; ++place) {
    const std::size_t taxel = taxel_of(line, place);
    if (taxels[taxel] == TaxelStatus::invalid) continue;
    before += taken_[taxel] * last_[taxel];
    now += taken_[taxel] * ratio[taxel];
    if (!(ratio[taxel] - last_[taxel] > jump)) continue;
    jump = ratio[taxel] - last_[taxel];
    jumping = place;
  }
  if (jumping == places_) return;
  const double fall = 1.0 - std::max(1.0 - now, kLeastLeft) / std::max(1.0 - before, kLeastLeft);
  const std::size_t taxel = taxel_of(line, jumping);
  if (fall < kLeastFall || others_answer(line, jumping, fall, ratio, sigma_ratio, taxels) ||
      frames_[taxel] == kMostFrames) {
    return;
  }
  ++frames_[taxel];
  taxels[taxel] = TaxelStatus::invalid;
  check_line(line, ratio, sigma_ratio, taxels);
}

/// Or nothing can be seen of it. A reading counts by the fall that is expected of it; one that rises is pressed, too.
bool Spikes::others_answer(std::size_t line, std::size_t jumping, double fall, std::span<const double> ratio,
                           double sigma_ratio, std::span<const TaxelStatus> taxels) const noexcept {
  double stay = 0.0;
  double answer = 0.0;
  double small = 0.0;
  double small_fallen = 0.0;
  double small_count = 0.0;
  for (std::size_t place = 0; place < places_; ++place) {
    const std::size_t taxel = taxel_of(line, place);
    if (place == jumping || taxels[taxel] == TaxelStatus::invalid) continue;
    const double expected = fall * last_[taxel];
    const double fallen = last_[taxel] - ratio[taxel];
    if (expected > kSeenSigmas * sigma_ratio) {
      answer += fallen > 0.5 * expected ? expected : 0.0;
      stay += std::abs(fallen) <= 0.5 * expected ? expected : 0.0;
    } else if (fallen > -kSeenSigmas * sigma_ratio && (place > jumping + kNear || place + kNear < jumping)) {
      small += expected;
      small_fallen += fallen;
      small_count += 1.0;
    }
  }
  const double noise = kSeenTogether * sigma_ratio * std::sqrt(small_count);
  if (small - small_fallen > noise && small_fallen < 0.5 * small) stay += small;
  if (small_fallen > noise && small_fallen >= 0.5 * small) answer += small;
  return stay <= kMoreStay * answer;
}

}  // namespace dermis::compensation
