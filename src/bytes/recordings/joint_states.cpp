// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/joint_states.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "dermis/bytes/recordings/mcap.hpp"

namespace dermis::bytes::recordings {
namespace {

bool has_joints(const McapChannel& channel) {
  return channel.encoding == "cdr" && channel.schema_name == ros_messages::kJointState;
}

}  // namespace

Result<std::vector<std::string>> joint_topics(const std::string& path) {
  const Result<std::unique_ptr<McapReader>> mcap = McapReader::open(path);
  if (!mcap) return mcap.error();
  McapMessage message;
  for (bool more = !(*mcap)->statistics() || (*mcap)->channels().empty(); more;) {
    const Result<bool> got = (*mcap)->next(message);
    if (!got) return got.error();
    more = *got;
  }
  std::vector<std::string> topics;
  for (const auto& [id, channel] : (*mcap)->channels()) {
    if (has_joints(channel)) topics.push_back(channel.topic);
  }
  std::sort(topics.begin(), topics.end());
  topics.erase(std::unique(topics.begin(), topics.end()), topics.end());
  return topics;
}

Status read_joint_states(const std::string& path, const std::string& topic,
                         const std::function<void(Nanos, const ros_messages::JointNumbers&)>& take) {
  const Result<std::unique_ptr<McapReader>> mcap = McapReader::open(path);
  if (!mcap) return mcap.error();
  McapMessage message;
  ros_messages::JointNumbers joints;
  while (true) {
    const Result<bool> got = (*mcap)->next(message);
    if (!got) return got.error();
    if (!*got) return Done{};
    const McapChannel& channel = (*mcap)->channels().at(message.channel);
    if (channel.topic != topic || !has_joints(channel)) continue;
    if (Status decoded = ros_messages::decode_joint_state(message.data, joints); !decoded) {
      return bad_input(fmt::format("{}: message {} of {}: {}", path, message.sequence, topic, decoded.error().message));
    }
    const std::uint64_t longest = std::numeric_limits<std::int64_t>::max();
    take(Nanos(static_cast<std::int64_t>(std::min(message.log_time, longest))), joints);
  }
}

}  // namespace dermis::bytes::recordings
