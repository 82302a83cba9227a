// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "dermis/core/result.hpp"

namespace dermis::files {

/// Where the bytes of an output file go until it is complete.
struct OutputPlace {
  std::string target;     ///< The file behind a symbolic link, so that a rename replaces the file and not the link.
  std::string temporary;  ///< In the folder of the target; empty where the target is written directly.
  int descriptor = -1;
};

/// Opens a new file beside `path`, or `path` itself where it is there and no regular file (/dev/stdout, a pipe).
[[nodiscard]] Result<OutputPlace> open_output(const std::string& path);

/// Writes all of the bytes, at `offset` where one is given, else where the descriptor stands. Returns 0, or the errno.
[[nodiscard]] int write_all(int descriptor, std::span<const std::byte> bytes, std::optional<std::uint64_t> offset = {});

/// Has the disk keep the name of a file, as far as its file system can.
void synchronise_folder_of(const std::string& path);

[[nodiscard]] Error cannot_write(const std::string& path, int error_number);

}  // namespace dermis::files
