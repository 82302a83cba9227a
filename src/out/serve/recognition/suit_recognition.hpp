// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/live/suits/live_suit.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/parts/part.hpp"
#include "out/serve/recognition/frame_joiner.hpp"
#include "out/serve/recognition/live_recognition.hpp"
#include "out/serve/requests/json_request.hpp"
#include "out/serve/topics/event_topic.hpp"

namespace dermis::out::serve {

/// The topic /suit/recognition of docs/stream.md: touches of several arrays together, or of one beside further
/// readings. Thread-safe: each array on a thread of its own.
class SuitRecognition final : public Part {
 public:
  /// By the classes of the suit, which must have some. Fails where they do not fit its arrays, and as Topics::add()
  /// does. `topics` and `recorder` must outlive it.
  [[nodiscard]] static Result<std::unique_ptr<SuitRecognition>> create(const ServedSuit& suit, Topics& topics,
                                                                       SuitRecorder& recorder);

  /// "/recognition/readings" where the examples had further readings: {"values": [31.5, null, ...]}, as they are now,
  /// in the order of the examples; null: missing. They hold for half a second of the frames of the first array.
  [[nodiscard]] std::vector<websocket::Service> services() override;
  void hear(const live::suits::ArrayResult& result) override;

 private:
  SuitRecognition(LiveRecognition recognition, const std::vector<ServedArray>& arrays, std::vector<std::size_t> places,
                  EventTopic topic);

  [[nodiscard]] Result<std::string> take_readings(const JsonRequest& request);

  void read_further(Nanos time);

  LiveRecognition recognition_;
  std::vector<std::size_t> places_;  ///< In the suit, of each array of the examples.
  FrameJoiner joiner_;
  EventTopic topic_;
  std::mutex readings_mutex_;
  std::optional<std::vector<float>> pending_{};  ///< Further readings that no frame has seen yet.
  // Used by the thread of the first array alone.
  std::vector<float> further_;
  std::optional<Nanos> further_time_{};
  std::vector<std::size_t> order_{};
  std::vector<bytes::ros_messages::Hypothesis> results_{};
  std::vector<std::uint8_t> message_{};
};

/// Applies the classes of several arrays to those of a suit, which are found by their names. One may have another name
/// where the suit has no other array. Fails where they do not fit.
[[nodiscard]] Result<LiveRecognition> recognition_of_suit(const learn::recognition::Classes& classes,
                                                          const std::vector<ServedArray>& arrays);

}  // namespace dermis::out::serve
