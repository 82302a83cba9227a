// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/sources/rehearsing_hand.hpp"

#include <algorithm>
#include <chrono>

namespace dermis::live::sources {
namespace {

constexpr std::uint64_t kPressesToAMistake = 8;
constexpr double kSeesMistakeSeconds = 0.6;  // the page hears ten times a second

enum class Mistake : std::uint8_t { beside, one_more, forgotten };

}  // namespace

RehearsingHand::RehearsingHand(std::size_t taxels, std::uint64_t seed) : random_(seed), force_n_(taxels) {}

const std::vector<double>& RehearsingHand::move(const GuideWords& words, double seconds) {
  const double while_s = std::chrono::duration<double>(words.hold_time).count();
  seconds_ += seconds;
  if (!is_on_) {
    if (words.press && seconds_ > while_s) put_on(words);
    return force_n_;
  }
  const bool sees_mistake = words.is_wrong && seconds_ > while_s + kSeesMistakeSeconds;
  release_seconds_ = words.press ? 0.0 : release_seconds_ + seconds;
  if (sees_mistake || release_seconds_ > 0.5 * while_s) take_off();
  return force_n_;
}

void RehearsingHand::put_on(const GuideWords& words) {
  std::vector<std::size_t> taxels = taxels_of(words);
  if (taxels.empty()) return;
  if (random_.below(kPressesToAMistake) == 0) err(taxels);
  for (const std::size_t taxel : taxels) force_n_[taxel] = words.weight_n;
  is_on_ = true;
  seconds_ = 0.0;
}

void RehearsingHand::take_off() {
  std::fill(force_n_.begin(), force_n_.end(), 0.0);
  is_on_ = false;
  seconds_ = 0.0;
  release_seconds_ = 0.0;
}

/// Those of the array.
std::vector<std::size_t> RehearsingHand::taxels_of(const GuideWords& words) const {
  std::vector<std::size_t> taxels = {words.taxel};
  if (words.together_with) taxels.push_back(*words.together_with);
  std::erase_if(taxels, [&](std::size_t taxel) { return taxel >= force_n_.size(); });
  return taxels;
}

/// A single taxel is not forgotten: the guide would not notice.
void RehearsingHand::err(std::vector<std::size_t>& taxels) {
  const std::uint64_t kinds = taxels.size() > 1 ? 3 : 2;
  const std::size_t of = random_.below(taxels.size());
  const std::size_t beside = (taxels[of] + 1) % force_n_.size();
  switch (static_cast<Mistake>(random_.below(kinds))) {
    case Mistake::beside: taxels[of] = beside; break;
    case Mistake::one_more: taxels.push_back(beside); break;
    case Mistake::forgotten: taxels.erase(taxels.begin() + static_cast<std::ptrdiff_t>(of)); break;
  }
}

}  // namespace dermis::live::sources
