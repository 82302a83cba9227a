// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>

#include "dermis/touch/frames/frames.hpp"
#include "live/fleet/message_id.hpp"

namespace dermis::live::fleet {

/// The session of a robot that a reader follows, so that frames of two processes never mix. The later process is
/// followed; another one only where nothing came of that for long.
class FollowedSession {
 public:
  enum class Answer : std::uint8_t {
    same,   ///< The message is of the session.
    next,   ///< Another session begins with it.
    other,  ///< It is of a process that has been replaced.
  };

  /// `time`: of the message in the stream.
  [[nodiscard]] Answer take(const MessageId& id, Nanos time);

  /// How many frames are missing before this message of the session. 0 where that is not known.
  [[nodiscard]] std::uint64_t missing_before(const MessageId& id) const noexcept;
  /// The next message begins behind this one.
  void pass(const MessageId& id) noexcept;

 private:
  std::optional<std::uint64_t> session_{};
  Nanos last_{};
  std::optional<std::uint64_t> next_frame_{};
};

}  // namespace dermis::live::fleet
