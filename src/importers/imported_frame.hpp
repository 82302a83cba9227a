// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>

#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"
#include "dermis/importers/import_options.hpp"

namespace dermis::importers {

/// Leaves nothing of another source in the frame but its buffers.
inline void begin_frame(RawFrame& frame, Nanos time) {
  frame.time = time;
  frame.temperature_celsius.reset();
  frame.supply_v.reset();
  frame.acquisition = {};
}

/// When frame `index` of a file without times was taken.
[[nodiscard]] Result<Nanos> time_of_frame(const std::string& place, std::size_t index, double rate_hz);

/// Tells that the last frame is left out.
void tell_cut(const ImportOptions& options, const std::string& place, std::size_t frames);

}  // namespace dermis::importers
