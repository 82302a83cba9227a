// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/health/weight_check.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::learn::health {

/// How many times as much the film of an array conducts as it says, by an object of this weight that stood on it. A
/// press counts whose readings beside it a film explains, on all sides; a larger object is none. 1: nothing is clear.
/// `idle_siemens`: of the taxels [rows, cols].
[[nodiscard]] double film_change(const ArrayDescription& array, const std::vector<double>& idle_siemens,
                                 double weight_n, const std::vector<WeighedPress>& presses);

}  // namespace dermis::learn::health
