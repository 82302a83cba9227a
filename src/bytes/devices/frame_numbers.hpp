// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::devices {

/// The numbers and times that a device gives to its frames, counted on where they wrap, also over lost frames.
class FrameNumbers {
 public:
  /// The device counts modulo 2^sequence_bits, and its clock [time_unit] modulo 2^32. More than `max_lost` missing
  /// frames are a restart of the device. So are a step back of the number or of the clock by less than half of its
  /// range, and a clock beyond 2^62 ns. No frames are lost then, and both go on from the device's values. With
  /// `datagrams`, frames whose number is up to 63 back, and whose clock is not ahead, are late or doubled instead.
  FrameNumbers(unsigned sequence_bits, Nanos time_unit, std::uint32_t max_lost, bool datagrams) noexcept
      : mask_(UINT32_MAX >> (32U - sequence_bits)), time_unit_(time_unit), max_lost_(max_lost), datagrams_(datagrams) {}

  /// Fills sequence, device_time and lost_before; false, and nothing is filled, where the frame is late or doubled.
  [[nodiscard]] bool count(std::uint32_t sequence, std::optional<std::uint32_t> time,
                           Acquisition& acquisition) noexcept;

 private:
  [[nodiscard]] bool is_late(std::uint32_t sequence, std::optional<std::uint32_t> time) const noexcept;

  std::uint32_t mask_;
  Nanos time_unit_;
  std::uint32_t max_lost_;
  bool datagrams_;
  std::optional<std::uint64_t> sequence_;
  std::optional<std::uint64_t> time_;
};

}  // namespace dermis::bytes::devices
