// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "dermis/out/serve/session.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// Plays a recording on a port of its own, beside the running session, whose clients, limits and listeners notice
/// nothing. One at a time. Not thread-safe.
class PlayedRecording {
 public:
  /// The suit that takes its frames from a recording.
  using PlayedSuit = std::function<Result<ServedSuit>(const std::string& recording)>;

  /// `options`: of the session that goes on.
  PlayedRecording(SessionOptions options, PlayedSuit suit);
  PlayedRecording(const PlayedRecording&) = delete;
  PlayedRecording& operator=(const PlayedRecording&) = delete;
  ~PlayedRecording();

  /// Ends the one before. Returns the port of the new one. Fails where the recording does not fit the suit.
  [[nodiscard]] Result<std::uint16_t> play(const std::string& recording);

 private:
  void end();

  SessionOptions options_;
  const PlayedSuit suit_;
  std::unique_ptr<Session> session_;  // null: none is played
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace dermis::out::serve
