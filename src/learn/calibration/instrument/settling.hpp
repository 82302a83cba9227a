// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"

namespace dermis::learn::calibration {

/// The share of a reading that is found again in the next one of the scan.
struct SettlingEstimate {
  double share = 0.0;
  double standard_error = 0.0;
  [[nodiscard]] bool is_significant() const noexcept;
};

/// From frames that press one taxel alone: what the idle reading behind it rises by, over what its own rises by. Rubber
/// and circuit reach the reading before it as far, so that its rise is taken away. Empty: too few such presses. `array`
/// may know of the curve and the offset of its ADC; what it says of its settling is not used. `loads` name frames that
/// exist.
[[nodiscard]] std::optional<SettlingEstimate> measure_settling(const ArrayDescription& array,
                                                               std::span<const RawFrame> frames,
                                                               std::span<const Load> loads);

}  // namespace dermis::learn::calibration
