// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "out/serve/recording/last_minute.hpp"

namespace dermis::out::serve {

/// A piece of time, ends included.
struct Selection {
  Nanos first{};
  Nanos last{};
};

/// The frames of one array. Fails where there is none in the selection.
[[nodiscard]] Result<std::vector<RawFrame>> selected_frames(const LastMinute& minute, std::size_t array,
                                                            const Selection& selection);

/// Writes the frames of one array as frames.csv.
[[nodiscard]] Status save_csv(std::span<const RawFrame> frames, FrameShape shape, const std::string& path);

/// Writes the forces of one array, as `dermis run` makes them from these frames: without a tare.
[[nodiscard]] Status save_forces(std::span<const RawFrame> frames, const touch::pipeline::Model& model,
                                 const std::string& path);

/// Writes the frames of all arrays as a recording; returns how many. Fails where there is none in the selection.
[[nodiscard]] Result<std::size_t> save_recording(const LastMinute& minute,
                                                 const std::vector<bytes::recordings::RecordedArray>& arrays,
                                                 const Selection& selection, const std::string& path);

}  // namespace dermis::out::serve
