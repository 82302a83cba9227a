// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "dermis/live/sources/pacer.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::sources {

/// Sets counts, temperature and supply of the frame of that number, from 0 on without end; numbers rise.
using MakeFrame = std::function<void(std::uint64_t number, RawFrame& frame)>;

/// Sends frames at a rate from the first next() on, with sequence and device time, until `stop` is set. Frames that are
/// not fetched within 500 ms are lost.
class SimulatedDevice final : public FrameSource {
 public:
  /// `rate_hz` > 0
  SimulatedDevice(MakeFrame make_frame, const FrameShape& shape, double rate_hz, const std::atomic<bool>* stop);

  [[nodiscard]] Result<bool> next(RawFrame& frame) override;
  [[nodiscard]] std::optional<Readiness> readiness() const override;
  [[nodiscard]] Result<Polled> poll(RawFrame& frame) override;
  [[nodiscard]] std::optional<FrameShape> shape() const override { return shape_; }
  [[nodiscard]] SourceStatistics statistics() const override;
  [[nodiscard]] bool is_live() const override { return true; }

 private:
  void begin();
  void stamp(RawFrame& frame, Nanos taken, Nanos arrival, std::uint64_t lost);
  [[nodiscard]] std::uint64_t frames_overdue(Nanos now) const;
  [[nodiscard]] Nanos moment_of(std::uint64_t frame) const;

  MakeFrame make_frame_;
  FrameShape shape_;
  double rate_hz_;
  const std::atomic<bool>* stop_;
  std::optional<Pacer> pacer_;  // from the first frame on
  Nanos begin_steady_{};
  Nanos begin_utc_{};
  std::uint64_t next_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t frames_ = 0;
  Nanos first_arrival_{};
  Nanos last_arrival_{};
};

}  // namespace dermis::live::sources
