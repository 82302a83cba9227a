// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "dermis/learn/recognition/segment.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::out::serve {

/// The frames of the first of several arrays, with the last frames of the others beside them. Thread-safe: each array
/// on a thread of its own. Allocates only when made.
class FrameJoiner {
 public:
  /// Taxels of each array; at least one array.
  explicit FrameJoiner(const std::vector<std::size_t>& taxels);

  /// Keeps the newtons of an array that is not the first. Rejected frames are passed over.
  void keep(std::size_t array, const ForceFrame& force);

  /// All arrays side by side at a frame of the first. An array whose frame is further than
  /// learn::recognition::kLongestSilence from it has no load. Valid until the next call.
  [[nodiscard]] const ForceFrame& join(const ForceFrame& first);

 private:
  struct Kept {
    std::optional<Nanos> time{};
    std::vector<float> newtons{};
  };

  std::mutex mutex_;
  std::vector<Kept> others_;
  ForceFrame joined_;
};

}  // namespace dermis::out::serve
