// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/core/result.hpp"
#include "dermis/pipeline/model.hpp"
#include "dermis/recordings/suit_recording.hpp"
#include "serve/recording/last_minute.hpp"

namespace dermis::serve {

/// A piece of time, ends included.
struct Selection {
  Nanos first{};
  Nanos last{};
};

/// Writes the frames of one array as frames.csv; returns how many. Fails where there is none in the selection.
[[nodiscard]] Result<std::size_t> save_csv(const LastMinute& minute, std::size_t array, FrameShape shape,
                                           const Selection& selection, const std::string& path);

/// Writes the forces of one array, as `dermis run` makes them from these frames: without a tare. Fails as save_csv().
[[nodiscard]] Status save_forces(const LastMinute& minute, std::size_t array, const pipeline::Model& model,
                                 const Selection& selection, const std::string& path);

/// Writes the frames of all arrays as a recording; as save_csv().
[[nodiscard]] Result<std::size_t> save_recording(const LastMinute& minute,
                                                 const std::vector<recordings::RecordedArray>& arrays,
                                                 const Selection& selection, const std::string& path);

}  // namespace dermis::serve
