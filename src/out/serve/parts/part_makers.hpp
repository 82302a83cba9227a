// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

#include "out/serve/parts/host.hpp"

namespace dermis::out::serve {

PartMaker make_threats, make_frame_topics, make_health, make_recognition, make_suit_recognition, make_calibration,
    make_teaching, make_body, make_live_settings, make_tares, make_playback, make_recording, make_resumption,
    make_result_recorder, make_marks, make_fleet_models, make_publishing;

/// The parts of a server, in the order in which they are made and hear a frame.
[[nodiscard]] std::span<PartMaker* const> part_makers();

}  // namespace dermis::out::serve
