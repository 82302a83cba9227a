// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dermis/bytes/devices/source_uri.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::devices {

/// The bytes since the last frame: many of them mean that the protocol is another. Memory is bounded. Not thread-safe.
class UndecodedBytes {
 public:
  void clear();
  void add(std::span<const std::uint8_t> bytes, Nanos arrival);

  /// Bytes of several frames and of 5 s hold no frame. `shape`: of the frames, where it is known.
  [[nodiscard]] bool are_too_many(const std::optional<FrameShape>& shape, Nanos at) const;

  /// Names the protocol that the bytes look like.
  [[nodiscard]] Error error(const SourceUri& uri) const;

 private:
  std::vector<std::uint8_t> first_;
  std::uint64_t count_ = 0;
  Nanos begin_{};
};

/// "13x6"
[[nodiscard]] std::string shape_text(const FrameShape& shape);

}  // namespace dermis::bytes::devices
