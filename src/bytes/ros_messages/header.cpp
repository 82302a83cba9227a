// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/ros_messages/header.hpp"

#include <limits>

namespace dermis::bytes::ros_messages {

void write_stamp(CdrWriter& writer, Nanos time) {
  std::int64_t seconds = time.count() / kNanosPerSecond;
  std::int64_t nanos = time.count() % kNanosPerSecond;
  if (nanos < 0) {
    nanos += kNanosPerSecond;
    --seconds;
  }
  using Seconds = std::numeric_limits<std::int32_t>;
  if (seconds > Seconds::max()) {
    seconds = Seconds::max();
    nanos = kNanosPerSecond - 1;
  } else if (seconds < Seconds::min()) {
    seconds = Seconds::min();
    nanos = 0;
  }
  writer.write(static_cast<std::int32_t>(seconds));
  writer.write(static_cast<std::uint32_t>(nanos));
}

void write_header(CdrWriter& writer, Nanos time, std::string_view frame_id) {
  write_stamp(writer, time);
  writer.write_text(frame_id);
}

}  // namespace dermis::bytes::ros_messages
