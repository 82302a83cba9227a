// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "dermis/core/result.hpp"

namespace dermis::files {

/// The file beside its target that an output is written to. It goes with this, but where it has taken the target's
/// place.
class UnfinishedFile {
 public:
  UnfinishedFile() = default;  ///< None: the target is written directly.
  explicit UnfinishedFile(std::string path);
  UnfinishedFile(UnfinishedFile&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  UnfinishedFile& operator=(UnfinishedFile&& other) noexcept;
  ~UnfinishedFile();

  /// Whether there is one, and it has not taken its place.
  [[nodiscard]] bool exists() const noexcept { return !path_.empty(); }

  /// Empty where there is none.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  /// Becomes the target, at once. Fails where the system refuses it.
  [[nodiscard]] Status take_place_of(const std::string& target);

 private:
  std::string path_;
};

/// Removes all unfinished files of the process, which must end then: who begins or finishes one from now on waits for
/// ever. Thread-safe.
void remove_unfinished_files();

/// Where the bytes of an output file go until it is complete.
struct OutputPlace {
  std::string target;  ///< The file behind a symbolic link, so that a rename replaces the file and not the link.
  UnfinishedFile unfinished;
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
