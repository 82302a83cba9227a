// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// The quantity in a forces.csv for each taxel.
enum class ForceColumn {
  newtons,        ///< ForceFrame::newtons
  sigma_newtons,  ///< ForceFrame::sigma_newtons
};

/// Writes forces.csv (docs/file-formats.md), or a file of the same shape with the standard deviations. Numbers have the
/// fewest digits that read back as the same number. `nan` is no force, `inf` a standard deviation without bound. Not
/// thread-safe.
class ForcesCsvWriter {
 public:
  [[nodiscard]] static Result<ForcesCsvWriter> create(const std::string& path, std::size_t rows, std::size_t cols,
                                                      ForceColumn column = ForceColumn::newtons);

  /// Appends a frame of rows * cols forces. Returns the first write error as soon as it is known.
  [[nodiscard]] Status write(const ForceFrame& frame);
  /// Puts the complete file in its place. Without it, no file remains.
  [[nodiscard]] Status commit();

 private:
  ForcesCsvWriter(AtomicFile file, std::size_t taxel_count, ForceColumn column);

  AtomicFile file_;
  [[maybe_unused]] std::size_t taxel_count_;  ///< What write() asserts.
  ForceColumn column_;
  std::string line_;
};

}  // namespace dermis::bytes::files
