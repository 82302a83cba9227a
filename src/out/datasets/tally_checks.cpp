// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/tally_checks.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "out/datasets/tally_numbers.hpp"

namespace dermis::out::datasets {

Status check_windows(const EpisodeTally& tally, const EpisodeOptions& options) {
  std::uint64_t longest = 0;
  for (const ArrayTally& array : tally.arrays) longest = std::max(longest, array.most_of_episode);
  if (longest >= options.window) return Done{};
  return bad_field(
      "window", fmt::format("no episode has {} frames; {} is the longest that one can fill", options.window, longest));
}

void tell_stale_steps(const EpisodeTally& tally, const EpisodeOptions& options) {
  constexpr double kFaster = 1.05;
  if (!options.notice || !options.times.empty()) return;
  const ArrayTally* fastest = nullptr;
  for (const ArrayTally& array : tally.arrays) {
    if (fastest == nullptr || rate_of(array) > rate_of(*fastest)) fastest = &array;
  }
  if (fastest == nullptr || options.fps <= kFaster * rate_of(*fastest) || fastest->stale_steps == 0) return;
  options.notice(fmt::format("{} of {} steps have no new frame: {} steps a second, and no array sends more than {:.3g}",
                             fastest->stale_steps, fastest->steps, options.fps, rate_of(*fastest)));
}

}  // namespace dermis::out::datasets
