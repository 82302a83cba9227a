// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string_view>

#include "bytes/ros_messages/cdr.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::ros_messages {

inline constexpr std::int64_t kNanosPerSecond = 1'000'000'000;

/// builtin_interfaces/Time; a time that it cannot hold (1901 ... 2038) becomes its nearest end.
void write_stamp(CdrWriter& writer, Nanos time);

/// std_msgs/Header.
void write_header(CdrWriter& writer, Nanos time, std::string_view frame_id);

}  // namespace dermis::bytes::ros_messages
