// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis {

/// A device's clock -> the host's steady clock, from pairs of device time and arrival:
///   arrival = offset + (1 + drift) * device time + delay, delay >= 0.
/// The line is below all pairs of the last 15 to 30 s of the device and as near to them as possible. It is an edge of
/// their lower convex hull [Moon, Skelly, Towsley, "Estimation and removal of clock skew from network delay
/// measurements", INFOCOM 1999]. So the least delay counts as none, and bursts do not move the line. A device restarts
/// if its time goes back, or leaps ahead of the host by more than delay can explain. The line then begins anew. A
/// device time that stands still belongs to a clock that ticks slower than frames come. The frames get the time of its
/// tick. If it has stood still for a second, or since the line began, it is no clock. The frames then get the time of
/// their arrival. O(1) amortised a frame; allocates nothing after construction. Not thread-safe.
class ClockMapping {
 public:
  /// Adds the pair of the next frame. Returns when the frame was taken, by the host's clock: not later than its
  /// arrival.
  [[nodiscard]] Nanos map(Nanos device_time, Nanos arrival);

  /// The device was disconnected: the next pair begins anew.
  void restart() noexcept;

  /// How much faster the device's clock runs than the host's, in millionths; empty before a second of pairs.
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
    /// The greatest offset at which a line of this slope is below all pairs.
    [[nodiscard]] double offset_below(double slope) const noexcept;

   private:
    static constexpr std::size_t kMaxVertices = 256;
    std::vector<Pair> vertices_;
    double sum_device_ns_ = 0.0;
    double pairs_ = 0.0;
  };

  [[nodiscard]] bool has_restarted(Nanos device_time, Nanos arrival) const noexcept;
  void add(const Pair& pair);

  Hull hull_;  ///< Covers the last 15 to 30 s.
  Hull next_;  ///< Covers the last 0 to 15 s: takes over when hull_ spans 30 s.
  std::optional<Nanos> first_device_;
  Nanos first_arrival_{};
  Nanos last_device_{};
  double slope_ = 0.0;  ///< Slope of the lag over device time: -drift / (1 + drift).
  double offset_ns_ = 0.0;
};

}  // namespace dermis
