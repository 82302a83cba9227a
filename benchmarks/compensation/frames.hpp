// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::benchmarks {

/// Consecutive frames of four contacts that press within ten frames, slide, and let go, on taxels that idle at
/// 150-300 kohm; contacts go down to 400 ohm. Readings with one count of noise, rounded to counts, over the supply.
[[nodiscard]] std::vector<std::vector<double>> touch_sequence(const ArrayDescription& array, std::size_t frames);

}  // namespace dermis::benchmarks
