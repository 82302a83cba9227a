// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"

namespace dermis::learn::calibration {

/// The samples of an array whose circuit is known, by units 2 and 3. `doubts` go into them; `progress` as in
/// build_sample_database().
[[nodiscard]] Result<SampleDatabase> invert_frames(const ArrayDescription& array, std::span<const RawFrame> frames,
                                                   std::span<const Load> loads, Nanos settle_time,
                                                   const std::vector<std::string>& doubts,
                                                   const std::function<void(double)>& progress);

}  // namespace dermis::learn::calibration
