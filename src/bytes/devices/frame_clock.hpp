// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

#include "bytes/devices/chunk_stamps.hpp"
#include "dermis/bytes/devices/arrival_meter.hpp"
#include "dermis/bytes/devices/clock_mapping.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::devices {

/// Finds when each frame was taken: by the device's clock where it has one, else by the arrival of its last byte. Times
/// rise strictly, on the host's clock. Not thread-safe.
class FrameClock {
 public:
  /// `bytes` more have arrived.
  void add(std::uint64_t bytes, const Stamp& arrival) {
    received_ += bytes;
    chunks_.add(received_, arrival);
  }

  /// The device was away, so its clock begins anew.
  void restart() { device_clock_.restart(); }

  /// Sets the times of a frame that ends with the first `end` bytes. Reads frame.acquisition.device_time.
  void stamp(std::uint64_t end, RawFrame& frame) {
    const Stamp arrival = chunks_.of(end);
    frame.acquisition.arrival_steady = arrival.steady;
    frame.acquisition.arrival_utc = arrival.utc;
    const std::optional<Nanos> device_time = frame.acquisition.device_time;
    const Nanos taken = device_time ? device_clock_.map(*device_time, arrival.steady) : arrival.steady;
    // Frames that came together, and a clock that was found to run slower, must not bring time to stand or go back.
    last_taken_ = std::max(taken, last_taken_ + Nanos(1));
    frame.time = last_taken_ + utc_minus_steady_;
    arrivals_.add(arrival.steady);
  }

  /// Sets rate, jitter and drift.
  void describe(SourceStatistics& statistics) const {
    statistics.rate_hz = arrivals_.rate_hz();
    statistics.jitter = arrivals_.jitter();
    statistics.clock_drift_ppm = device_clock_.drift_ppm();
  }

  [[nodiscard]] std::uint64_t received_bytes() const { return received_; }

 private:
  std::uint64_t received_ = 0;
  ChunkStamps chunks_;
  ClockMapping device_clock_;
  ArrivalMeter arrivals_;
  Nanos last_taken_{};  // host's steady clock
  Nanos utc_minus_steady_ = [](const Stamp& stamp) { return stamp.utc - stamp.steady; }(now());
};

}  // namespace dermis::bytes::devices
