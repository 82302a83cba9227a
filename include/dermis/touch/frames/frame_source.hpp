// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis {

/// Shape of the frames of a source: RawFrame::counts has rows * cols values, row-major.
struct FrameShape {
  std::size_t rows = 0;
  std::size_t cols = 0;

  [[nodiscard]] std::size_t taxel_count() const noexcept { return rows * cols; }
  bool operator==(const FrameShape&) const = default;
};

/// The delivered and the missed frames of a source.
struct SourceStatistics {
  std::uint64_t frames = 0;               ///< Delivered.
  std::uint64_t lost_frames = 0;          ///< Never seen: gaps in the numbers of the device.
  std::uint64_t damaged_frames = 0;       ///< Seen and dropped: checksum, length or content cannot be right.
  std::uint64_t late_frames = 0;          ///< Came after later ones, by the device's clock: put in order or dropped.
  std::uint64_t repeated_frames = 0;      ///< With the number, time and readings of the one before: dropped.
  std::uint64_t skipped_bytes = 0;        ///< Bytes that belong to no delivered frame.
  std::uint64_t reconnections = 0;        ///< Times the device came back after it was unplugged or closed.
  double rate_hz = 0.0;                   ///< Delivered frames per second of arrival, over the last seconds.
  Nanos jitter{};                         ///< Standard deviation of the time between two arrivals, over the same.
  std::optional<double> clock_drift_ppm;  ///< The device's clock against the host's: positive if it runs fast.

  bool operator==(const SourceStatistics&) const = default;
};

/// A caller of several sources waits for the earlier of these, and polls then.
struct Readiness {
  int descriptor = -1;  ///< Readable when bytes have come; below 0: there is none.
  Nanos due{};          ///< A moment by the steady clock.
};

/// Outcome of FrameSource::poll().
enum class Polled { frame, nothing, end };

/// Where frames come from: a device, a recording or the simulator. Callers never ask which.
/// Not thread-safe: one reader.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Fills `frame` with the next frame, reusing its buffers. Returns false at the end of the source.
  [[nodiscard]] virtual Result<bool> next(RawFrame& frame) = 0;

  /// The next poll() is worth its while then. Empty where only next() can wait: of files, and of devices that are away.
  [[nodiscard]] virtual std::optional<Readiness> readiness() const { return std::nullopt; }

  /// Does the same as next() without waiting, where readiness() is known. Call it until it gives nothing.
  [[nodiscard]] virtual Result<Polled> poll(RawFrame& frame) {
    const Result<bool> more = next(frame);
    if (!more) return more.error();
    return *more ? Polled::frame : Polled::end;
  }

  /// Empty if it is known only with the first frame.
  [[nodiscard]] virtual std::optional<FrameShape> shape() const = 0;

  [[nodiscard]] virtual SourceStatistics statistics() const { return {}; }

  /// True for a device, real, simulated or played: its frames come at their own pace. False for a file, which is read
  /// at any pace.
  [[nodiscard]] virtual bool is_live() const { return false; }

  /// Place of the last frame, for messages: "frames.csv:17". Empty if the frame has only a number.
  [[nodiscard]] virtual std::string place() const { return {}; }
};

}  // namespace dermis
