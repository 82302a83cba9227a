// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/error_measures.hpp"

#include <cassert>
#include <cstddef>

namespace dermis::paper {

template <std::floating_point Real>
double pattern_error(std::span<const Real> targets, std::span<const Real> outputs) noexcept {
  assert(targets.size() == outputs.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const double difference = static_cast<double>(targets[k]) - static_cast<double>(outputs[k]);
    sum += difference * difference;
  }
  return 0.5 * sum;
}

template double pattern_error(std::span<const float>, std::span<const float>) noexcept;
template double pattern_error(std::span<const double>, std::span<const double>) noexcept;

}  // namespace dermis::paper
