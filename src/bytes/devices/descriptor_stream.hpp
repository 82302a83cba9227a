// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/bytes/devices/byte_stream.hpp"

namespace dermis::bytes::devices {

/// Bytes of a file, or of any path that can be read so.
[[nodiscard]] std::unique_ptr<ByteStream> make_file_stream(const std::string& path);
[[nodiscard]] std::unique_ptr<ByteStream> make_standard_input();
[[nodiscard]] std::unique_ptr<ByteStream> make_standard_output();

/// A new pseudo-terminal, raw, whose other side a program opens as a serial device. Each open() waits for a program
/// that has it open.
[[nodiscard]] Result<std::unique_ptr<ByteStream>> make_pseudo_terminal();

}  // namespace dermis::bytes::devices
