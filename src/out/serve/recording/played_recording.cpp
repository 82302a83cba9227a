// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/played_recording.hpp"

#include <utility>

namespace dermis::out::serve {

PlayedRecording::PlayedRecording(SessionOptions options, PlayedSuit suit)
    : options_(std::move(options)), suit_(std::move(suit)) {
  options_.server.port = 0;
  if (!options_.record.empty()) options_.recordings = std::exchange(options_.record, {});
  options_.dds.reset();
}

PlayedRecording::~PlayedRecording() {
  end();
}

void PlayedRecording::end() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  session_.reset();
  stop_ = false;
}

Result<std::uint16_t> PlayedRecording::play(const std::string& recording) {
  Result<ServedSuit> suit = suit_(recording);
  if (!suit) return suit.error();
  Result<std::unique_ptr<Session>> session = Session::create(*std::move(suit), options_);
  if (!session) return session.error();
  end();
  session_ = *std::move(session);
  thread_ = std::thread([this] { static_cast<void>(session_->run(stop_)); });
  return session_->port();
}

}  // namespace dermis::out::serve
