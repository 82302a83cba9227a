// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/live/dds/publisher.hpp"
#include "dermis/out/websocket/server.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// Who hears a message.
enum class Ends : std::uint8_t { stream, dds, both };

/// How a topic is called at each end; an end without a name does not have it.
struct TopicNames {
  std::string stream{};  ///< docs/stream.md
  std::string dds{};     ///< docs/ros.md
};

/// A topic of one type of message.
class Topic {
 public:
  /// Somebody listens at one of these ends.
  [[nodiscard]] bool is_wanted(Ends ends = Ends::both) const noexcept;
  /// To those who listen; a topic that is kept also where nobody does.
  void publish(Nanos time, std::span<const std::uint8_t> message, Ends ends = Ends::both,
               websocket::MessageKind kind = websocket::MessageKind::event) const;

 private:
  friend class Topics;
  websocket::Server* server_ = nullptr;
  live::dds::Publisher* publisher_ = nullptr;
  std::optional<websocket::ChannelId> channel_;
  std::optional<live::dds::TopicId> dds_topic_;
  bool is_kept_ = false;
};

/// The sink of all messages, with two ends: clients of the stream, and nodes of ROS 2 where they are wanted.
/// Thread-safe but for add(), which for an end of DDS must come before the first message.
class Topics {
 public:
  /// `server` must outlive it. Without `dds` there is the stream alone. Errors: those of live::dds::Publisher.
  [[nodiscard]] static Result<std::unique_ptr<Topics>> create(websocket::Server& server,
                                                              const std::optional<live::dds::PublisherOptions>& dds);

  static constexpr std::size_t kMessageBytes = 1024;
  /// Nodes that come later get the last message, or none.
  enum class Keep : std::uint8_t { none, last };

  /// `message_bytes` and `keep`: as live::dds::Topic has them. Errors: those of live::dds::Publisher; none without DDS.
  [[nodiscard]] Result<Topic> add(const TopicNames& names, const bytes::ros_messages::MessageType& type,
                                  std::size_t message_bytes = kMessageBytes, Keep keep = Keep::none);

  /// Messages that the network of DDS did not take.
  [[nodiscard]] std::uint64_t left_out() const noexcept { return publisher_ ? publisher_->left_out() : 0; }
  /// A frame that was due for the stream is not in it, as the machine does not follow.
  void thin() noexcept { frames_not_streamed_.fetch_add(1, std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t frames_not_streamed() const noexcept { return frames_not_streamed_.load(); }
  [[nodiscard]] bool has_dds() const noexcept { return publisher_ != nullptr; }
  /// As DDS names them: "rt/chest/frame".
  [[nodiscard]] const std::vector<std::string>& dds_topics() const noexcept { return dds_topics_; }

 private:
  Topics(websocket::Server& server, std::unique_ptr<live::dds::Publisher> publisher);

  websocket::Server& server_;
  std::unique_ptr<live::dds::Publisher> publisher_;  // null: none is wanted
  std::vector<std::string> dds_topics_;
  std::atomic<std::uint64_t> frames_not_streamed_ = 0;
};

}  // namespace dermis::out::serve
