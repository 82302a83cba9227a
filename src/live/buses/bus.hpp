// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "live/buses/array_feed.hpp"

namespace dermis::live::buses {

/// An array that a connection brings.
struct BusArray {
  std::string name;    ///< Empty where it is the only one.
  FrameShape shape{};  ///< 0x0: its frames tell it.
};

/// When something came, and when it was taken.
struct Arrival {
  Nanos steady = std::chrono::steady_clock::now().time_since_epoch();
  Nanos utc = std::chrono::system_clock::now().time_since_epoch();
  Nanos taken = steady;  ///< By the steady clock.
};

/// One connection that brings the frames of several arrays. Thread-safe.
class Bus {
 public:
  explicit Bus(std::vector<BusArray> arrays) : feeds_(arrays.size()), arrays_(std::move(arrays)) {}
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;
  virtual ~Bus() = default;

  [[nodiscard]] const std::vector<BusArray>& arrays() const noexcept { return arrays_; }
  /// Names in messages the place that it is connected to.
  [[nodiscard]] virtual std::string name() const = 0;

  /// A reader of one of the arrays, for as long as it lives.
  void add(std::size_t array, const std::shared_ptr<ArrayFeed>& feed);

 protected:
  /// The readers of an array.
  [[nodiscard]] std::vector<std::shared_ptr<ArrayFeed>> readers(std::size_t array);
  /// The arrays that somebody reads.
  [[nodiscard]] std::vector<std::size_t> wanted();
  [[nodiscard]] std::vector<std::shared_ptr<ArrayFeed>> all_readers();

  /// Gives a frame its times, by the host's clock, and its readers the frame.
  void deliver(std::size_t array, const FrameShape& shape, const Arrival& arrival, RawFrame& frame);
  /// The same of a frame that has its times.
  void deliver_timed(std::size_t array, const FrameShape& shape, const RawFrame& frame);

 private:
  const Arrival begin_;
  std::mutex mutex_;  // Of what follows.
  std::vector<std::vector<std::weak_ptr<ArrayFeed>>> feeds_;
  const std::vector<BusArray> arrays_;
};

}  // namespace dermis::live::buses
