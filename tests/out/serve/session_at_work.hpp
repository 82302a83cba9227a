// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/out/serve/session.hpp"

namespace dermis::out::serve {

inline SessionOptions options_with(const std::string& record = {}) {
  SessionOptions options;
  options.server.port = 0;
  options.record = record;
  return options;
}

/// A session at work.
class Work {
 public:
  explicit Work(std::unique_ptr<Session> session) : session_(std::move(session)) {
    thread_ = std::thread([this] { outcome_ = session_->run(stop_); });
  }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;
  ~Work() { static_cast<void>(end()); }

  std::uint16_t port() const { return session_->port(); }
  Status end() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    return outcome_;
  }

 private:
  std::unique_ptr<Session> session_;
  std::atomic<bool> stop_ = false;
  Status outcome_ = Done{};
  std::thread thread_;
};

inline std::unique_ptr<Session> session_of(ServedSuit suit, const SessionOptions& options) {
  Result<std::unique_ptr<Session>> session = Session::create(std::move(suit), options);
  EXPECT_TRUE(session) << session.error().message;
  return *std::move(session);
}

/// Frames of each array in a complete recording.
inline std::vector<std::size_t> recorded_frames(const std::string& path) {
  const auto reader = bytes::recordings::SuitRecordingReader::open(path);
  EXPECT_TRUE(reader) << reader.error().message;
  EXPECT_TRUE((*reader)->complete());
  std::vector<std::size_t> frames((*reader)->arrays().size());
  std::size_t array = 0;
  RawFrame frame;
  for (auto more = (*reader)->next(array, frame); more && *more; more = (*reader)->next(array, frame)) ++frames[array];
  return frames;
}

}  // namespace dermis::out::serve
