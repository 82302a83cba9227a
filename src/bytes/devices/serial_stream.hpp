// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/bytes/devices/byte_stream.hpp"

namespace dermis::bytes::devices {

/// A serial port, raw 8N1; its errors say what to do.
[[nodiscard]] std::unique_ptr<ByteStream> make_serial_stream(const std::string& path, unsigned baud);

}  // namespace dermis::bytes::devices
