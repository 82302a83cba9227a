// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>

#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::recordings {

/// The meaning of a topic's messages for the frames; what holds counts is an image, also of sensors without places.
enum class MessageKind : std::uint8_t { none, image, acquisition, temperature, sensors, force, contacts };

/// Last part of the topic that carries the temperatures of several sensors. They are an image of one row or, with one
/// a taxel, of the array's shape.
inline constexpr const char* kSensorsTopic = "temperatures";

/// Frames are read of messages in CDR alone.
[[nodiscard]] MessageKind kind_of(const McapChannel& channel);

/// Messages of sensors of touch: where there are some, the images of a bag are those of cameras.
[[nodiscard]] bool is_tactile_state(const McapChannel& channel);

/// Counts and stamp of a message of the kind `image`.
[[nodiscard]] Result<FrameShape> decode_counts(const McapChannel& channel, std::span<const std::uint8_t> message,
                                               RawFrame& frame);

}  // namespace dermis::bytes::recordings
