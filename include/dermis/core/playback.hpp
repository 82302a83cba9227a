// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>

#include "dermis/core/frames.hpp"

namespace dermis {

/// What the playback of a recording is to do from now on.
struct PlaybackCommand {
  bool play = true;             ///< After the end, from the beginning again, unless it is to seek.
  double speed = 1.0;           ///< Times the recorded pace: taken between 0.01 and 100.
  std::optional<Nanos> seek{};  ///< Taken between the first and the last frame.

  bool operator==(const PlaybackCommand&) const = default;
};

struct PlaybackStatus {
  enum class State : std::uint8_t { playing, paused, ended };
  State state = State::playing;
  Nanos now{};  ///< In the times of the recording.
  double speed = 1.0;

  bool operator==(const PlaybackStatus&) const = default;
};

}  // namespace dermis
