// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "dermis/calibration/sample_database.hpp"

namespace dermis::calibration {

/// There are loads, they name frames that exist, and a pressure can be turned into a force.
[[nodiscard]] Status check_loads(const ArrayDescription& array, std::size_t frame_count, std::span<const Load> loads);

/// What a load presses with in all [N].
[[nodiscard]] double total_newtons(const Load& load, const ArrayDescription& array);

/// The sum of the loads of every frame [N]; none for unlabelled frames.
[[nodiscard]] std::vector<std::optional<double>> newtons_of_frames(const ArrayDescription& array,
                                                                   std::size_t frame_count,
                                                                   std::span<const Load> loads);

/// The loads of every frame; none for unlabelled frames.
[[nodiscard]] std::vector<std::vector<Load>> group_by_frame(std::span<const Load> loads, std::size_t frame_count);

/// Forces of every taxel that the loads of one frame tell: `known_newtons` [taxels], `totals` and `unloaded`. Taxels
/// that the sheet does not have carry nothing.
void expand_loads(const ArrayDescription& array, std::span<const Load> loads, Sample& sample);

}  // namespace dermis::calibration
