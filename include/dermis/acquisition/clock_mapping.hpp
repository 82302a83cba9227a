// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/core/frames.hpp"

namespace dermis::acquisition {

/// A device's clock -> the host's steady clock, from pairs of device time and arrival:
///   arrival = offset + (1 + drift) * device time + delay, delay >= 0.
/// The line lies below all pairs of the last 15 to 30 s of the device and as near to them as it can: an edge of their
/// lower convex hull [Moon, Skelly, Towsley, "Estimation and removal of clock skew from network delay measurements",
/// INFOCOM 1999]. So the least delay counts as none, and bursts do not move it. A device time that goes back, or leaps
/// ahead of the host by more than delay can explain, is a restart of the device: the line is begun anew. One that
/// stands is that of a clock which ticks slower than frames come: they take the time of its tick. It is no clock where
/// it has stood for a second, or since the line began: frames are taken when they arrive. O(1) amortised a frame;
/// allocates nothing after construction. Not thread-safe.
class ClockMapping {
 public:
  /// Takes the pair of the next frame and returns when the frame was taken, by the host: not later than its arrival.
  [[nodiscard]] Nanos map(Nanos device_time, Nanos arrival);

  /// The device was away: the next pair begins anew.
  void restart() noexcept;

  /// How much faster than the host's the device's clock runs, in millionths; empty before a second of pairs.
  [[nodiscard]] std::optional<double> drift_ppm() const noexcept;

 private:
  struct Pair {
    double device_ns;  ///< Since the first pair.
    double lag_ns;     ///< Arrival - device time, since the first pair.
  };

  /// Lower convex hull of pairs added in the order of their device times.
  class Hull {
   public:
    Hull() { vertices_.reserve(kMaxVertices); }
    void clear() noexcept;
    [[nodiscard]] bool is_empty() const noexcept { return vertices_.empty(); }
    void add(const Pair& pair);
    [[nodiscard]] double span_ns() const noexcept;
    /// Slope of the edge over the mean device time of all pairs.
    [[nodiscard]] double middle_slope() const noexcept;
    /// The greatest offset with which a line of this slope lies below all pairs.
    [[nodiscard]] double offset_below(double slope) const noexcept;

   private:
    static constexpr std::size_t kMaxVertices = 256;
    std::vector<Pair> vertices_;
    double sum_device_ns_ = 0.0;
    double pairs_ = 0.0;
  };

  [[nodiscard]] bool has_restarted(Nanos device_time, Nanos arrival) const noexcept;
  void add(const Pair& pair);

  Hull hull_;  ///< Of the last 15 to 30 s.
  Hull next_;  ///< Of the last 0 to 15 s: takes over when hull_ spans 30 s.
  std::optional<Nanos> first_device_;
  Nanos first_arrival_{};
  Nanos last_device_{};
  double slope_ = 0.0;  ///< Of the lag over device time: -drift / (1 + drift).
  double offset_ns_ = 0.0;
};

}  // namespace dermis::acquisition
