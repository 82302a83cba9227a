// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// A page plays a recording in the place of what is live.
#include "out/serve/recording/played_recording.hpp"

#include <utility>

#include "bindings/browser/page_link.hpp"

namespace dermis::out::serve {

PlayedRecording::PlayedRecording(SessionOptions options, PlayedSuit suit)
    : options_(std::move(options)), suit_(std::move(suit)) {}

PlayedRecording::~PlayedRecording() = default;

Result<std::uint16_t> PlayedRecording::play(const std::string& recording) {
  Result<ServedSuit> suit = suit_(recording);
  if (!suit) return suit.error();
  browser::serve_next(*std::move(suit));
  return std::uint16_t{0};
}

}  // namespace dermis::out::serve
