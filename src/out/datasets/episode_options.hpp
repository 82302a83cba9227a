// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "dermis/out/datasets/episodes.hpp"

namespace dermis::out::datasets {

/// Each of the times is an episode of the only recording.
[[nodiscard]] bool are_split(const std::vector<std::vector<Nanos>>& times, std::size_t recordings);

/// EpisodeTally::how. `are_recorded`: models are those of the recordings.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> described(const EpisodeOptions& options,
                                                                         bool are_recorded);

[[nodiscard]] std::vector<Nanos> joined(const std::vector<std::vector<Nanos>>& times);

/// Times of the steps of each recording, or of each episode of the only one.
[[nodiscard]] Status check_times(const std::vector<std::vector<Nanos>>& times, std::size_t recordings);

}  // namespace dermis::out::datasets
