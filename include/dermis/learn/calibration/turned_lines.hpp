// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <string>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"

namespace dermis::learn::calibration {

/// A sentence where single taxels that `loads` name show that frames have rows and columns exchanged, or in reverse
/// order. build_sample_database() fails with it.
[[nodiscard]] std::optional<std::string> find_turned_lines(const ArrayDescription& array,
                                                           std::span<const RawFrame> frames,
                                                           std::span<const Load> loads);

}  // namespace dermis::learn::calibration
