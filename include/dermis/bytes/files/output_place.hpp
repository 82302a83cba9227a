// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "dermis/bytes/files/unfinished_file.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// Destination of the bytes of an output file until it is complete.
struct OutputPlace {
  std::string target;  ///< The file behind a symbolic link, so that a rename replaces the file and not the link.
  UnfinishedFile unfinished;
  int descriptor = -1;
};

/// Opens a new file beside `path` (UnfinishedFile), or `path` itself if it exists and is no regular file (/dev/stdout,
/// a pipe).
[[nodiscard]] Result<OutputPlace> open_output(const std::string& path);

/// Writes all of the bytes, at `offset` if one is given, else at the position of the descriptor. Returns 0, or the
/// errno.
[[nodiscard]] int write_all(int descriptor, std::span<const std::byte> bytes, std::optional<std::uint64_t> offset = {});

/// Makes the name of a file durable on disk, as far as its file system can.
void synchronise_folder_of(const std::string& path);

enum class EarlierFile { stays_unread, may_be_read };

/// Takes the name of an output from now on, so that no other process writes it. open_output() of the same file goes on
/// with it. The file that stands there may not be read, by check_readable(), unless that is what the command is for.
/// Fails as UnfinishedFile::begin() does. Thread-safe.
[[nodiscard]] Status claim_output(const std::string& path, EarlierFile earlier);

/// Gives back the names that were never opened. Thread-safe.
void release_claims();

/// Fails where an output will replace the file, by whatever name it is read. Whoever opens a file to read asks first.
/// Thread-safe.
[[nodiscard]] Status check_readable(const std::string& path);

}  // namespace dermis::bytes::files
