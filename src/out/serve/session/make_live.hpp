// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>

#include "dermis/live/suits/live_suit.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/out/serve/session.hpp"
#include "dermis/out/websocket/server.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/parts/part_list.hpp"

namespace dermis::out::serve {

/// The arrays of the suit at work, whose sources it takes. `parts` hear each frame and must outlive it.
[[nodiscard]] Result<std::unique_ptr<live::suits::LiveSuit>> make_live(ServedSuit& suit, const PartList& parts,
                                                                       const SessionOptions& options);

/// Empty: the sources are live. The playback must outlive it.
[[nodiscard]] std::optional<websocket::PlaybackService> playback_service(live::suits::Playback* playback);

}  // namespace dermis::out::serve
