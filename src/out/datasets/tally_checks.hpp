// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/out/datasets/episodes.hpp"

namespace dermis::out::datasets {

/// A window that is never full would be a mistake.
[[nodiscard]] Status check_windows(const EpisodeTally& tally, const EpisodeOptions& options);

/// Says where the clock of the steps is faster than every array.
void tell_stale_steps(const EpisodeTally& tally, const EpisodeOptions& options);

}  // namespace dermis::out::datasets
