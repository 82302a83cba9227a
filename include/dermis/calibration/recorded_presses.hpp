// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "dermis/calibration/calibrate.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/loads.hpp"
#include "dermis/core/result.hpp"

namespace dermis::calibration {

/// The frames of a press, with those before it in which nothing presses: [first, end).
struct RecordedPress {
  std::size_t first = 0;
  std::size_t end = 0;

  bool operator==(const RecordedPress&) const = default;
};

/// The presses of a recording, by rising frame. One ends where frames are labelled unloaded again, or where no frame
/// came for a second and more. What has no load in it is none.
[[nodiscard]] std::vector<RecordedPress> recorded_presses(std::span<const RawFrame> frames,
                                                          std::span<const Load> loads);

/// A calibration without each of the presses. They run side by side. Errors: those of
/// calibrate(); no two presses. `progress` gets the share done, from any thread.
[[nodiscard]] Result<std::vector<Calibration>> calibrate_without_each(const ArrayDescription& array,
                                                                      std::span<const RawFrame> frames,
                                                                      std::span<const Load> loads, Nanos settle_time,
                                                                      std::span<const RecordedPress> presses,
                                                                      const std::function<void(double)>& progress = {});

}  // namespace dermis::calibration
