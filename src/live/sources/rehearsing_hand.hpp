// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dermis/live/sources/guide_voice.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::live::sources {

/// The hand of somebody who follows the guide. It puts the weights on after about the length of a hold, and takes them
/// off when told. One press of eight, on average, begins with a mistake, which the hand does not see itself. Told that
/// something else is pressed than was asked for, it takes everything off and begins anew.
class RehearsingHand {
 public:
  RehearsingHand(std::size_t taxels, std::uint64_t seed);

  /// The loads on the array [taxels, N] `seconds` after the last call, by the guide's present words.
  const std::vector<double>& move(const GuideWords& words, double seconds);

 private:
  [[nodiscard]] std::vector<std::size_t> taxels_of(const GuideWords& words) const;
  void put_on(const GuideWords& words);
  void take_off();
  void err(std::vector<std::size_t>& taxels);

  Random random_;
  std::vector<double> force_n_;
  bool is_on_ = false;
  double seconds_ = 0.0;          // since the hand moved
  double release_seconds_ = 0.0;  // since the guide asked to take the weights off
};

}  // namespace dermis::live::sources
