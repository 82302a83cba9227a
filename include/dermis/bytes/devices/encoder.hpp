// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::devices {

/// Frames -> the bytes that a device of a protocol would send: for emulators and tests. Not thread-safe.
class Encoder {
 public:
  Encoder() = default;
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  virtual ~Encoder() = default;

  /// Appends the bytes of the next frame. Counts are rounded and clamped to what the protocol can carry.
  virtual void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) = 0;

  /// Appends the rest of the last frame, if part of it waits for the next one (WiReSens).
  virtual void finish(std::vector<std::uint8_t>& /*bytes*/) {}

  /// The request that a device of this protocol needs before each frame; empty if it sends on its own.
  [[nodiscard]] virtual std::string_view request() const noexcept { return {}; }
};

}  // namespace dermis::bytes::devices
