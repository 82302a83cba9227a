// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>

#include "dermis/touch/frames/frames.hpp"

namespace dermis {

/// The command to a playback from now on.
struct PlaybackCommand {
  bool play = true;             ///< After the end it starts from the beginning, unless `seek` is set.
  double speed = 1.0;           ///< Factor on the recorded pace, clamped to 0.01 ... 100.
  std::optional<Nanos> seek{};  ///< Clamped to the times of the first and the last frame.

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
