// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/acquisition/byte_stream.hpp"

namespace dermis::acquisition {

/// A serial port, raw 8N1; its errors say what to do.
[[nodiscard]] std::unique_ptr<ByteStream> make_serial_stream(const std::string& path, unsigned baud);

}  // namespace dermis::acquisition
