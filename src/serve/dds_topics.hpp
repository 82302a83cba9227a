// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"
#include "dermis/core/surface.hpp"
#include "dermis/core/wrench.hpp"
#include "dermis/dds/publisher.hpp"
#include "dermis/live/live_suit.hpp"
#include "dermis/messages/live_messages.hpp"
#include "dermis/serve/served_suit.hpp"
#include "serve/contacts_in_suit.hpp"
#include "serve/suit_points.hpp"

namespace dermis::serve {

/// The topics of docs/ros.md. Thread-safe: each array on a thread of its own.
class DdsTopics {
 public:
  /// `suit` must outlive it. Publishes where the arrays are; again when a body moves them. Fails as dds::Publisher
  /// does.
  [[nodiscard]] static Result<std::unique_ptr<DdsTopics>> create(const ServedSuit& suit,
                                                                 const dds::PublisherOptions& options);

  /// Every frame, of which somebody listens.
  void publish(const live::ArrayResult& result);

  /// The taxels of the whole suit, and what presses on it. One at a time, as publish_health().
  void publish_suit();
  void publish_health(std::span<const messages::Diagnosis> diagnoses, Nanos time);

  /// Messages that the network did not take.
  [[nodiscard]] std::uint64_t left_out() const noexcept { return publisher_->left_out(); }

 private:
  /// What the contacts of an array do to the suit.
  struct Press {
    std::optional<Nanos> time{};  // empty: there was no frame yet
    Wrench in_suit{};
  };

  /// An array, touched by its thread alone but for its last press.
  struct Array {
    std::string name;
    FrameShape shape;
    Pose suit_from_array;
    ContactsInSuit contacts;
    dds::TopicId raw = 0;
    dds::TopicId force = 0;
    dds::TopicId force_sigma = 0;
    dds::TopicId wrench = 0;
    std::vector<std::uint8_t> message{};
    std::mutex press_mutex{};
    Press press{};

    Array(const ServedSuit& suit, std::size_t index);
  };

  DdsTopics(const ServedSuit& suit, std::unique_ptr<dds::Publisher> publisher);
  [[nodiscard]] Status add_topics();
  void publish_transforms();
  void publish_images(Array& array, const live::ArrayResult& result);
  void publish_values(Array& array, dds::TopicId topic, std::span<const float> values, Nanos time);
  void publish_wrench(Array& array, const live::ArrayResult& result);
  void take_presses();
  void publish_suit_wrench(Nanos newest);

  const ServedSuit& suit_;
  std::unique_ptr<dds::Publisher> publisher_;
  std::deque<Array> arrays_;
  SuitPoints points_;
  dds::TopicId contacts_topic_ = 0;
  dds::TopicId points_topic_ = 0;
  dds::TopicId wrench_topic_ = 0;
  dds::TopicId diagnostics_topic_ = 0;
  dds::TopicId transforms_topic_ = 0;
  std::uint64_t body_version_ = 0;     // Of which the transforms were published.
  std::vector<Press> presses_;         // Of all arrays at one time.
  std::vector<std::uint8_t> message_;  // Of the suit.
};

}  // namespace dermis::serve
