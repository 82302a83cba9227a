// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/stream_descriptions.hpp"

#include <chrono>
#include <string>
#include <utility>

#include "dermis/bytes/recordings/frame_batches.hpp"
#include "live/fleet/message_id.hpp"

namespace dermis::live::fleet {
namespace {

/// A session describes its array again at least once a minute, before frames.
constexpr std::chrono::seconds kNotLongerBefore{90};

/// Sessions that are not known gave no checksum.
bool is_whole(const StoredMessage& description, std::uint64_t session) {
  return session == 0 || description.id.ends_with("." + std::to_string(bytes::recordings::checksum(description.bytes)));
}

}  // namespace

Result<const StreamDescription*> StreamDescriptions::find(std::uint64_t session, const StoredMessage& near) {
  if (found_ && found_->session == session) return &*found_;
  if (wanted_ != session) {
    const auto first = first_since(broker_, of_, near.time - kNotLongerBefore, near.sequence);
    if (!first) return first.error();
    wanted_ = session;
    next_ = *first;
  }
  while (true) {
    auto message = broker_.next(of_.stream, of_.subject, next_);
    if (!message) return message.error();
    if (!*message) return nullptr;
    const bool is_wanted = parse_message_id((*message)->id).session == session;
    if (!is_wanted && (*message)->sequence > near.sequence) return nullptr;
    next_ = (*message)->sequence + 1;
    if (!is_wanted || !is_whole(**message, session)) continue;
    Result<bytes::recordings::RecordedArray> array = bytes::recordings::read_description((*message)->bytes);
    if (!array) continue;
    found_ = {session, std::move((*message)->bytes), *std::move(array)};
    return &*found_;
  }
}

}  // namespace dermis::live::fleet
