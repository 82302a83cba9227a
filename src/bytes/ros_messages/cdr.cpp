// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/ros_messages/cdr.hpp"

namespace dermis::bytes::ros_messages {

std::uint8_t* CdrWriter::append(std::size_t count) {
  bytes_.resize(bytes_.size() + count);
  return bytes_.data() + (bytes_.size() - count);
}

}  // namespace dermis::bytes::ros_messages
