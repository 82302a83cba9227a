// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>

#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"
#include "dermis/store/atomic_file.hpp"

namespace dermis::store {

/// Writes forces.csv (docs/file-formats.md): newtons with the shortest digits that read back as the same number, `nan`
/// where no force is given. Not thread-safe.
class ForcesCsvWriter {
 public:
  [[nodiscard]] static Result<ForcesCsvWriter> create(const std::string& path, std::size_t rows, std::size_t cols);

  /// Appends a frame of rows * cols forces. Returns the first write error as soon as it is known.
  [[nodiscard]] Status write(const ForceFrame& frame);
  /// Puts the complete file in its place; without it, nothing is left behind.
  [[nodiscard]] Status commit();

 private:
  ForcesCsvWriter(AtomicFile file, std::size_t taxel_count);

  AtomicFile file_;
  [[maybe_unused]] std::size_t taxel_count_;  ///< What write() asserts.
  std::string line_;
};

}  // namespace dermis::store
