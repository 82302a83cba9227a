// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/live/fleet/robot_health.hpp"
#include "dermis/live/fleet/stream_address.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::fleet {

struct PublisherOptions {
  BrokerAddress broker{};
  std::string robot;                          ///< check_name()
  bool take_over = false;                     ///< The name, also from a process that publishes.
  std::function<void(std::string)> notice{};  ///< Told in one line where the server goes and comes back. Thread-safe.
};

/// How publishing goes.
struct PublisherCounts {
  std::uint64_t batches = 0;   ///< That the server has stored.
  std::uint64_t frames = 0;    ///< In them.
  std::uint64_t bytes = 0;     ///< In the batches.
  std::uint64_t left_out = 0;  ///< Frames without room, while the server did not follow, or too large for it.
};

/// Publishes the frames of a robot's arrays as batches of at most 100 ms (recordings/frame_batches.hpp). The server
/// stores each batch once, and those of an array in order: the next one is sent when it has acknowledged the last.
/// Where it does not answer, 16 MB of each array wait.
class FramePublisher {
 public:
  /// Fails where the plugin is not there, on names that are no part of a subject, and where another process publishes
  /// as this robot. A server that does not answer is told to `notice` and asked again.
  [[nodiscard]] static Result<std::unique_ptr<FramePublisher>> create(
      std::vector<bytes::recordings::RecordedArray> arrays, PublisherOptions options);
  FramePublisher(const FramePublisher&) = delete;
  FramePublisher& operator=(const FramePublisher&) = delete;
  /// Sends what waits for 2 s. A server that does not answer may take as long again.
  ~FramePublisher();

  /// Never waits for the server. One thread for each array.
  void publish(std::size_t array, const RawFrame& frame);

  /// Contacts of the array, as bytes::ros_messages::encode_contacts() has them. Never waits. One thread for each array.
  void publish_contacts(std::size_t array, Nanos time, std::span<const std::uint8_t> message);

  /// Never waits. One that a newer one follows before it is sent is not sent, nor is one that the server did not take.
  void publish(const RobotHealth& health);

  [[nodiscard]] PublisherCounts counts() const noexcept;
  /// Frames of one array that were left out, as PublisherCounts counts those of all.
  [[nodiscard]] std::uint64_t left_out(std::size_t array) const noexcept;

 private:
  class Implementation;
  explicit FramePublisher(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::live::fleet
