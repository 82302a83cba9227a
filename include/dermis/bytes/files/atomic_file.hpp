// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "dermis/bytes/files/output_place.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// A file that appears complete or not at all. The bytes go to a temporary file in the same folder, which commit()
/// renames over the target. A target that exists and is no regular file (/dev/stdout, a pipe) is written directly, at
/// least every 50 ms of write(). Not thread-safe.
class AtomicFile {
 public:
  /// Opens the temporary file; fails if the folder cannot be written.
  [[nodiscard]] static Result<AtomicFile> create(const std::string& path);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  /// Without commit(), removes the temporary file and leaves the target untouched.
  ~AtomicFile();

  /// Appends to a buffer of 1 MiB. The first error is kept, and later bytes are dropped.
  void write(std::string_view bytes);
  /// Writes at an offset from the beginning of the file. Fails if the target is written directly.
  void write_at(std::uint64_t offset, std::string_view bytes);
  /// Reads back the bytes written so far; zeros where there are none.
  void read_at(std::uint64_t offset, std::span<char> bytes);
  /// The first error, or Done, as far as the buffer was written out.
  [[nodiscard]] Status status() const;
  /// Writes the rest, waits for the disk and renames. Call it once.
  [[nodiscard]] Status commit();

 private:
  explicit AtomicFile(OutputPlace place);
  void flush();
  void flush_for_reader();
  void keep_error(int error_number);
  void close();

  std::string target_;
  UnfinishedFile unfinished_;
  int descriptor_ = -1;
  std::string buffer_;
  std::chrono::steady_clock::time_point last_flush_{};
  std::optional<Error> first_error_;
};

}  // namespace dermis::bytes::files
