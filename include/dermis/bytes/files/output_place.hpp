// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// The temporary file beside the target of an output. The destructor removes it, unless it has become the target.
class UnfinishedFile {
 public:
  UnfinishedFile() = default;  ///< None: the target is written directly.
  UnfinishedFile(UnfinishedFile&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  UnfinishedFile& operator=(UnfinishedFile&& other) noexcept;
  ~UnfinishedFile();

  /// A new one, open for reading and writing under the descriptor; -1 and errno if the system refuses it. There is no
  /// moment at which remove_unfinished_files() would miss it. Thread-safe.
  [[nodiscard]] static std::pair<UnfinishedFile, int> create_beside(const std::string& target);

  /// Whether there is one that has not become the target.
  [[nodiscard]] bool exists() const noexcept { return !path_.empty(); }

  /// Empty if there is none.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  /// Becomes the target, atomically. Fails if the system refuses it.
  [[nodiscard]] Status take_place_of(const std::string& target);

 private:
  std::string path_;
};

/// Removes all unfinished files of the process, which must end then. A thread that begins or finishes one from now on
/// blocks for ever. Thread-safe.
void remove_unfinished_files();

/// Destination of the bytes of an output file until it is complete.
struct OutputPlace {
  std::string target;  ///< The file behind a symbolic link, so that a rename replaces the file and not the link.
  UnfinishedFile unfinished;
  int descriptor = -1;
};

/// Opens a new file beside `path`, or `path` itself if it exists and is no regular file (/dev/stdout, a pipe). The new
/// file is called PATH.PROCESS.NUMBER.tmp. Such files of processes that were killed are removed.
[[nodiscard]] Result<OutputPlace> open_output(const std::string& path);

/// Writes all of the bytes, at `offset` if one is given, else at the position of the descriptor. Returns 0, or the
/// errno.
[[nodiscard]] int write_all(int descriptor, std::span<const std::byte> bytes, std::optional<std::uint64_t> offset = {});

/// Makes the name of a file durable on disk, as far as its file system can.
void synchronise_folder_of(const std::string& path);

[[nodiscard]] Error cannot_write(const std::string& path, int error_number);

}  // namespace dermis::bytes::files
