// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::out::serve {

/// The newtons of one array at even times, between those of its frames. Allocates only when made. Not thread-safe.
class FrameResampler {
 public:
  /// `rate_hz` 0: every frame as it comes.
  FrameResampler(double rate_hz, std::size_t taxels);

  /// Time goes back or pauses for more than half a second: the frames before have nothing to do with this one.
  [[nodiscard]] bool leaps_to(const ForceFrame& force) const noexcept;

  /// Calls `use` with the newtons at each time up to that of the frame.
  template <typename Use>
  void take(const ForceFrame& force, const Use& use) {
    if (leaps_to(force)) restart(force);
    if (period_ == Nanos{}) use(std::span<const float>(force.newtons));
    while (period_ > Nanos{} && due_ <= force.time) {
      use(interpolated(force));
      due_ += period_;
    }
    keep(force);
  }

 private:
  void restart(const ForceFrame& force) noexcept;
  [[nodiscard]] std::span<const float> interpolated(const ForceFrame& force) noexcept;
  void keep(const ForceFrame& force) noexcept;

  Nanos period_;
  Nanos due_{};
  std::optional<Nanos> last_{};  ///< Frame that came.
  std::vector<float> last_newtons_;
  std::vector<float> between_;
};

}  // namespace dermis::out::serve
