// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"

namespace dermis {

/// Where frames come from: a device, a recording or the simulator. Callers never ask which.
/// Not thread-safe: one reader.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Fills `frame` with the next frame, reusing its buffers. Returns false at the end of the source.
  [[nodiscard]] virtual Result<bool> next(RawFrame& frame) = 0;
};

}  // namespace dermis
