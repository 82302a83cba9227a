// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis {

/// Where raw frames go: a recording or a file of another format. All frames of a sink have one shape.
/// Not thread-safe: one writer.
class FrameSink {
 public:
  FrameSink() = default;
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;
  virtual ~FrameSink() = default;

  /// Returns the first write error as soon as it is known.
  [[nodiscard]] virtual Status write(const RawFrame& frame) = 0;

  /// Completes the file. Call it once, after the last frame.
  [[nodiscard]] virtual Status commit() = 0;
};

}  // namespace dermis
