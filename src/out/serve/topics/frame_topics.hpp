// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "dermis/bytes/bodies/wrench.hpp"
#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "out/serve/parts/part.hpp"
#include "out/serve/topics/contacts_in_suit.hpp"
#include "out/serve/topics/pace.hpp"
#include "out/serve/topics/suit_points.hpp"
#include "out/serve/topics/topics.hpp"

namespace dermis::out::serve {

/// At least the bytes of a dermis_msgs/msg/RawFrame of the array, by which its history has room for enough of them.
[[nodiscard]] std::size_t raw_frame_bytes(const ArrayDescription& array);

/// The topics of frames: those of docs/stream.md, thinned to /stream/rate_hz, and those of docs/ros.md with all frames.
class FrameTopics final : public Part {
 public:
  /// `suit` and `topics` must outlive it. Errors: those of Topics::add().
  [[nodiscard]] static Result<std::unique_ptr<FrameTopics>> create(const ServedSuit& suit, Topics& topics);

  [[nodiscard]] std::vector<LiveParameter> parameters() override;
  void keep(std::size_t array, const RawFrame& frame) override;
  void hear(const live::suits::ArrayResult& result) override;
  /// A recording that is played shows the forces of the new model from now on.
  void model_changed(std::size_t array) override;
  /// The taxels of the whole suit as they were in the last frames that were published, and what presses on it.
  void tick(std::int64_t tick) override;

 private:
  /// The force of an array's contacts on the suit.
  struct Press {
    std::optional<Nanos> time{};  // empty: there was no frame yet
    Wrench in_suit{};
  };

  /// An array, touched by one thread at a time but for its last press.
  ///
  /// Many members: seven are topics.
  struct Array {
    const ServedArray& served;
    FrameShape shape;
    bytes::ros_messages::Pitch pitch;
    ContactsInSuit contacts;
    Topic frame{};
    Topic raw{};
    Topic conductance{};
    Topic force_grid{};
    Topic force{};
    Topic force_sigma{};
    Topic wrench{};
    std::atomic<bool> is_as_recorded;  // forces and contacts are those of the played recording
    Pace pace{};
    std::uint64_t late = 0;  // frames that were due
    std::vector<std::uint8_t> message{};
    ForceFrame played{};
    std::mutex press_mutex{};
    Press press{};

    Array(const ServedSuit& suit, std::size_t index);
  };

  FrameTopics(const ServedSuit& suit, Topics& topics);
  [[nodiscard]] Status add_topics();
  [[nodiscard]] Status add_topics_of(Array& array);
  [[nodiscard]] bool has_time_for(Array& array, const live::suits::ArrayResult& result);
  [[nodiscard]] bool is_as_recorded(const Array& array, const live::suits::ArrayResult& result) const;
  void hear_played(Array& array, const live::suits::ArrayResult& result);
  void publish_frame(Array& array, const live::suits::ArrayResult& result, bool is_due);
  void publish_images(Array& array, const live::suits::ArrayResult& result, bool is_due);
  void publish_values(Array& array, const Topic& topic, std::span<const float> values, Nanos time);
  void publish_contacts(Array& array, const live::suits::ArrayResult& result, bool is_due);
  void publish_wrench(Array& array, const live::suits::ArrayResult& result);
  void publish_points(Nanos time, Ends ends);
  void publish_suit_wrench();

  const ServedSuit& suit_;
  Topics& topics_;
  std::deque<Array> arrays_;
  SuitPoints points_;
  Topic contacts_topic_;
  Topic points_topic_;
  Topic wrench_topic_;
  std::vector<std::uint8_t> message_;  // of the suit
  std::atomic<double> rate_hz_{60.0};
  std::atomic<std::int64_t> stream_time_ns_{0};  // of the last frame that was due
  std::atomic<std::int64_t> last_time_ns_{0};    // of the last frame; 0: there was none
};

}  // namespace dermis::out::serve
