// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <initializer_list>

#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::simulation {

/// An option and the inclusive range of its values.
struct OptionRange {
  const char* field;  ///< "rubber.exponent"
  double value;
  double low;
  double high;
};

/// Names the first option that is out of its range or not a number.
[[nodiscard]] Status check_ranges(std::initializer_list<OptionRange> options);

}  // namespace dermis::learn::simulation
