// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/devices/arrival_meter.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::buses {

/// The number of lost frames, which others may have counted.
[[nodiscard]] std::uint32_t saturated_sum(std::uint32_t a, std::uint32_t b);

/// Frames of one array on their way from a bus to one reader, all of one shape. A reader that falls 4096 frames behind
/// loses the oldest. Thread-safe.
class ArrayFeed {
 public:
  /// `place` names the source in notices. Without a `shape` the first frame tells it.
  explicit ArrayFeed(std::function<void(const std::string&)> notice, std::string place = {},
                     std::optional<FrameShape> shape = {});
  ArrayFeed(const ArrayFeed&) = delete;
  ArrayFeed& operator=(const ArrayFeed&) = delete;
  ~ArrayFeed();

  // The bus calls these.
  /// A frame of another shape is damaged. It ends the feed where no other has come.
  void push(const FrameShape& shape, const RawFrame& frame);
  void count_damaged();
  void count_reconnection();
  void tell(const std::string& text) const;
  /// No more frames come; the first outcome is kept.
  void end(const Status& outcome);

  // The reader calls these.
  /// The oldest frame, by a swap. The end or its error come after all frames.
  [[nodiscard]] Result<Polled> take(RawFrame& frame);
  /// Until there is something to take.
  void wait(Nanos most);
  /// Readable while there is something to take.
  [[nodiscard]] int descriptor() const noexcept { return event_; }
  [[nodiscard]] std::optional<FrameShape> shape() const;
  [[nodiscard]] SourceStatistics statistics() const;

 private:
  void add(const RawFrame& frame);
  [[nodiscard]] std::string refuse(const FrameShape& shape);
  void signal();

  const std::function<void(const std::string&)> notice_;
  const std::string place_;
  const int event_;
  mutable std::mutex mutex_;  // Of what follows.
  std::condition_variable changed_;
  std::vector<RawFrame> ring_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::uint32_t left_out_ = 0;  // frames that no frame has told of yet
  std::optional<FrameShape> shape_;
  bool has_come_ = false;  // a frame
  bool has_told_ = false;  // of frames of another shape
  std::optional<Status> outcome_;
  ArrivalMeter arrivals_;
  SourceStatistics statistics_;
};

}  // namespace dermis::live::buses
