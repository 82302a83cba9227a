// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/live/forces/operation.hpp"
#include "stop_flag.hpp"

namespace dermis::app {

/// Forces of frame after frame, until the source ends or the command is stopped. `each(raw, force)` sees each of them.
template <typename Each>
Status process_all(live::forces::Operation& operation, Each each) {
  RawFrame raw;
  ForceFrame force;
  while (!stop_flag().load()) {
    const Result<bool> more = operation.frames->next(raw);
    if (!more) return more.error();
    if (!*more) break;
    operation.pipeline.process(raw, force);
    each(raw, force);
  }
  return Done{};
}

}  // namespace dermis::app
