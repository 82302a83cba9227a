// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>

#include "dermis/core/result.hpp"
#include "dermis/live/live_suit.hpp"
#include "dermis/serve/served_suit.hpp"
#include "dermis/serve/session.hpp"
#include "dermis/stream/server.hpp"
#include "serve/parts/part_list.hpp"

namespace dermis::serve {

/// The arrays of the suit at work, whose sources it takes. `parts` hear each frame and must outlive it.
[[nodiscard]] Result<std::unique_ptr<live::LiveSuit>> make_live(ServedSuit& suit, const PartList& parts,
                                                                const SessionOptions& options);

/// Empty: the sources are live. The playback must outlive it.
[[nodiscard]] std::optional<stream::PlaybackService> playback_service(live::Playback* playback);

}  // namespace dermis::serve
