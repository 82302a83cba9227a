// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <string>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/loads.hpp"

namespace dermis::calibration {

/// A sentence where single taxels that `loads` name show that frames have rows and columns exchanged, or in reverse
/// order. build_sample_database() fails with it.
[[nodiscard]] std::optional<std::string> find_turned_lines(const ArrayDescription& array,
                                                           std::span<const RawFrame> frames,
                                                           std::span<const Load> loads);

}  // namespace dermis::calibration
