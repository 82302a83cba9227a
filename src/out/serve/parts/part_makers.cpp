// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/parts/part_makers.hpp"

namespace dermis::out::serve {

/// A threat is published before anything else is done with the results of its frame. Then clients see them, then
/// lessons use them.
std::span<PartMaker* const> part_makers() {
  static constexpr PartMaker* kMakers[] = {
      make_threats,      make_frame_topics, make_health,     make_recognition,     make_suit_recognition,
      make_calibration,  make_teaching,     make_body,       make_live_settings,   make_tares,
      make_playback,     make_recording,    make_resumption, make_result_recorder, make_marks,
      make_fleet_models, make_publishing};
  return kMakers;
}

}  // namespace dermis::out::serve
