// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/simulation/option_range.hpp"

#include <sstream>

namespace dermis::learn::simulation {

Status check_ranges(std::initializer_list<OptionRange> options) {
  for (const OptionRange& option : options) {
    if (option.value >= option.low && option.value <= option.high) continue;
    std::ostringstream message;
    message << option.field << ": must be " << option.low << " to " << option.high << ", is " << option.value;
    return bad_input(message.str());
  }
  return Done{};
}

}  // namespace dermis::learn::simulation
