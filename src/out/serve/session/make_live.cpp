// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/session/make_live.hpp"

#include <cassert>
#include <utility>
#include <vector>

namespace dermis::out::serve {

std::optional<websocket::PlaybackService> playback_service(live::suits::Playback* playback) {
  if (playback == nullptr) return std::nullopt;
  return websocket::PlaybackService{playback->start(), playback->end(),
                                    [playback](const PlaybackCommand& command) { return playback->control(command); }};
}

Result<std::unique_ptr<live::suits::LiveSuit>> make_live(ServedSuit& suit, const PartList& parts,
                                                         const SessionOptions& options) {
  std::vector<live::suits::LiveArray> arrays;
  for (ServedArray& array : suit.arrays) {
    assert(array.source != nullptr && array.model != nullptr);
    arrays.push_back({array.name, std::move(array.source), array.model, array.surface});
  }
  live::suits::LiveOptions live_options;
  live_options.on_frame = [&parts](std::size_t array, const RawFrame& frame) { parts.keep(array, frame); };
  live_options.on_result = [&parts](const live::suits::ArrayResult& result) { parts.hear(result); };
  live_options.notice = options.server.notice;
  return live::suits::LiveSuit::create(std::move(arrays), std::move(live_options));
}

}  // namespace dermis::out::serve
