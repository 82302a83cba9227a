// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/followed_session.hpp"

#include <chrono>

namespace dermis::live::fleet {
namespace {

constexpr std::chrono::seconds kGoneAfter{10};

}  // namespace

FollowedSession::Answer FollowedSession::take(const MessageId& id, Nanos time) {
  const bool is_first = !session_;
  if (!is_first && *session_ != id.session && id.session < *session_ && time - last_ < kGoneAfter) return Answer::other;
  last_ = time;
  if (session_ == id.session) return Answer::same;
  session_ = id.session;
  next_frame_ = is_first ? std::nullopt : std::optional<std::uint64_t>(0);
  return is_first ? Answer::same : Answer::next;
}

std::uint64_t FollowedSession::missing_before(const MessageId& id) const noexcept {
  return id.frames > 0 && next_frame_ && id.first > *next_frame_ ? id.first - *next_frame_ : 0;
}

void FollowedSession::pass(const MessageId& id) noexcept {
  if (id.frames > 0) next_frame_ = id.first + id.frames;
}

}  // namespace dermis::live::fleet
