// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>

#include "dermis/bytes/devices/byte_stream.hpp"

namespace dermis::bytes::devices {

/// The stream of a device whose bytes hold several arrays. All streams of its place in this process share one
/// connection, and each gets all bytes from its opening on. Different threads may use them. A reader that falls more
/// than a mebibyte behind loses the oldest bytes.
[[nodiscard]] Result<std::unique_ptr<ByteStream>> make_shared_source_stream(const SourceUri& uri);

}  // namespace dermis::bytes::devices
