// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/recording_counts.hpp"

#include "bytes/recordings/message_kind.hpp"
#include "bytes/recordings/recording_description.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"

namespace dermis::bytes::recordings {

void RecordingCounts::count(const McapMessage& message, const McapChannel& channel) {
  ++messages_[message.channel];
  const std::string folder(topic_folder(channel.topic));
  const MessageKind kind = kind_of(channel);
  if (kind == MessageKind::acquisition && ros_messages::decode_acquisition(message.data, frame_)) {
    lost_[folder] += frame_.acquisition.lost_before;
  }
  if (kind != MessageKind::image) return;
  const Result<FrameShape> decoded = decode_counts(channel, message.data, frame_);
  if (!decoded) {
    if (unread_.empty())
      unread_ = "an image of " + printable(channel.topic) + " cannot be read: " + decoded.error().message;
    return;
  }
  if (!first_folder_) first_folder_ = folder;
  const auto [place, is_new] = images_.try_emplace(folder);
  Images& images = place->second;
  if (is_new) {
    images.channel = message.channel;
    images.counts.first_log_time = message.log_time;
    images.counts.shape = *decoded;
  }
  if (images.channel != message.channel) return;
  images.counts.last_log_time = message.log_time;
  ++images.counts.frames;
}

FrameCounts RecordingCounts::in_folder(const std::string& folder) const {
  FrameCounts counts;
  if (const auto found = images_.find(folder); found != images_.end()) counts = found->second.counts;
  if (const auto found = lost_.find(folder); found != lost_.end()) counts.lost = found->second;
  return counts;
}

FrameCounts RecordingCounts::first() const {
  FrameCounts counts = first_folder_ ? in_folder(*first_folder_) : FrameCounts{};
  counts.lost = 0;
  for (const auto& [folder, lost] : lost_) counts.lost += lost;
  return counts;
}

}  // namespace dermis::bytes::recordings
