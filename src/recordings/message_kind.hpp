// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>

#include "dermis/recordings/mcap.hpp"

namespace dermis::recordings {

/// The meaning of a topic's messages for the frames.
enum class MessageKind : std::uint8_t { none, image, acquisition, temperature };

/// Frames are read of messages in CDR alone.
[[nodiscard]] MessageKind kind_of(const McapChannel& channel);

}  // namespace dermis::recordings
