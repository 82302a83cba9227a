// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/topics/topics.hpp"

#include <utility>

namespace dermis::out::serve {

bool Topic::is_wanted(Ends ends) const noexcept {
  return (ends != Ends::dds && channel_ && server_->has_subscribers(*channel_)) ||
         (ends != Ends::stream && dds_topic_ && publisher_->has_subscribers(*dds_topic_));
}

void Topic::publish(Nanos time, std::span<const std::uint8_t> message, Ends ends, websocket::MessageKind kind) const {
  if (ends != Ends::dds && channel_ && server_->has_subscribers(*channel_)) {
    server_->publish(*channel_, time, message, kind);
  }
  if (ends == Ends::stream || !dds_topic_) return;
  if (is_kept_ || publisher_->has_subscribers(*dds_topic_)) publisher_->publish(*dds_topic_, message);
}

Result<std::unique_ptr<Topics>> Topics::create(websocket::Server& server,
                                               const std::optional<live::dds::PublisherOptions>& dds) {
  if (!dds) return std::unique_ptr<Topics>(new Topics(server, nullptr));
  Result<std::unique_ptr<live::dds::Publisher>> publisher = live::dds::Publisher::create(*dds);
  if (!publisher) return publisher.error();
  return std::unique_ptr<Topics>(new Topics(server, *std::move(publisher)));
}

Topics::Topics(websocket::Server& server, std::unique_ptr<live::dds::Publisher> publisher)
    : server_(server), publisher_(std::move(publisher)) {}

Result<Topic> Topics::add(const TopicNames& names, const bytes::ros_messages::MessageType& type,
                          std::size_t message_bytes, Keep keep) {
  Topic topic;
  topic.server_ = &server_;
  topic.publisher_ = publisher_.get();
  topic.is_kept_ = keep == Keep::last;
  if (!names.stream.empty()) topic.channel_ = server_.add_channel(names.stream, type.name, type.definition);
  if (names.dds.empty() || !publisher_) return topic;
  const Result<live::dds::TopicId> added = publisher_->add_topic({names.dds, type, message_bytes, topic.is_kept_});
  if (!added) return added.error();
  topic.dds_topic_ = *added;
  dds_topics_.push_back("rt" + names.dds);
  return topic;
}

}  // namespace dermis::out::serve
