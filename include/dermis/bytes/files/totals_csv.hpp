// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// Writes the force on the whole array frame by frame (docs/file-formats.md): `time_s,status,total_n,sigma_total_n,
/// left_out`, as ForceFrame::total() gives it. A frame of which all taxels are left out has the total `nan`. Not
/// thread-safe.
class TotalsCsvWriter {
 public:
  [[nodiscard]] static Result<TotalsCsvWriter> create(const std::string& path);

  /// Appends a frame. Returns the first write error as soon as it is known.
  [[nodiscard]] Status write(const ForceFrame& frame);
  /// Puts the complete file in its place. Without it, no file remains.
  [[nodiscard]] Status commit();

 private:
  explicit TotalsCsvWriter(AtomicFile file);

  AtomicFile file_;
  std::string line_;
};

}  // namespace dermis::bytes::files
