// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "dermis/core/result.hpp"

namespace dermis::store {

/// A file that appears complete or not at all: the bytes go to a temporary file in the same folder, which commit()
/// renames over the target. A target that is there and is not a regular file (/dev/stdout, a pipe) is written directly.
/// Not thread-safe.
class AtomicFile {
 public:
  /// Opens the temporary file; fails where the folder cannot be written.
  [[nodiscard]] static Result<AtomicFile> create(const std::string& path);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  /// Without commit(), removes the temporary file and leaves the target untouched.
  ~AtomicFile();

  /// Appends to a buffer of 1 MiB; the first error is kept, and all that follows is dropped.
  void write(std::string_view bytes);
  /// The first error, or Done, as far as the buffer was written out.
  [[nodiscard]] Status status() const;
  /// Writes the rest, waits for the disk and renames. To be called once.
  [[nodiscard]] Status commit();

 private:
  AtomicFile(std::string target, std::string temporary, int descriptor);
  void flush();
  void keep_error(int error_number);
  void close();

  std::string target_;
  std::string temporary_;  ///< Empty where the target is written directly.
  int descriptor_ = -1;
  std::string buffer_;
  std::optional<Error> first_error_;
};

}  // namespace dermis::store
