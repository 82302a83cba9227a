// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"

namespace dermis::learn::calibration {

/// The reading at which the readout saturates before its ADC ends [counts], where the labelled frames show one. There,
/// loads that differ twofold give the same last count, and hardly any reading stands just before it.
[[nodiscard]] std::optional<double> find_rail(const ArrayDescription& array, std::span<const RawFrame> frames,
                                              std::span<const Load> loads);

}  // namespace dermis::learn::calibration
