// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// A page plays a recording in the place of what is live (module.cpp).
#include "out/serve/recording/played_recording.hpp"

#include <utility>

namespace dermis::out::serve {

PlayedRecording::PlayedRecording(SessionOptions options, PlayedSuit suit)
    : options_(std::move(options)), suit_(std::move(suit)) {}

PlayedRecording::~PlayedRecording() = default;

Result<std::uint16_t> PlayedRecording::play(const std::string& recording) {
  static_cast<void>(recording);
  return bad_input("not yet");
}

}  // namespace dermis::out::serve
