// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/parts/part_makers.hpp"

namespace dermis::out::serve {

/// Those that need no other thread, in the order of the command's.
std::span<PartMaker* const> part_makers() {
  static constexpr PartMaker* kMakers[] = {make_frame_topics,    make_health,   make_calibration, make_live_settings,
                                           make_tares,           make_playback, make_recording,   make_resumption,
                                           make_result_recorder, make_marks};
  return kMakers;
}

}  // namespace dermis::out::serve
