// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/peaks.hpp"

#include <cmath>

namespace dermis::paper {

double peaks(double x, double y) noexcept {
  const double x2 = x * x;
  const double y2 = y * y;
  return 3.0 * (1.0 - x) * (1.0 - x) * std::exp(-x2 - (y + 1.0) * (y + 1.0)) -
         10.0 * (x / 5.0 - x2 * x - y2 * y2 * y) * std::exp(-x2 - y2) - std::exp(-(x + 1.0) * (x + 1.0) - y2) / 3.0;
}

PeaksSamples peaks_samples() {
  PeaksSamples samples;
  const auto place = [](std::size_t k) { return (static_cast<double>(k) - 30.0) / 10.0; };
  for (std::size_t row = 0; row < PeaksSamples::kSide; ++row) {
    for (std::size_t col = 0; col < PeaksSamples::kSide; ++col) {
      samples.inputs.insert(samples.inputs.end(), {place(col), place(row)});
      samples.targets.push_back(peaks(place(col), place(row)));
    }
  }
  return samples;
}

}  // namespace dermis::paper
