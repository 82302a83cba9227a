// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace dermis::learn::recognition {

/// |confidence - accuracy| over ten bins of confidence, weighted by how many answers are in each.
class CalibrationError {
 public:
  void add(double confidence, bool is_right) {
    const auto bin = std::min(static_cast<std::size_t>(confidence * kBins), kBins - 1);
    excess_[bin] += confidence - (is_right ? 1.0 : 0.0);
    count_ += 1.0;
  }
  [[nodiscard]] double value() const {
    double sum = 0.0;
    for (const double excess : excess_) sum += std::abs(excess);
    return count_ > 0.0 ? sum / count_ : 0.0;
  }

 private:
  static constexpr std::size_t kBins = 10;
  std::array<double, kBins> excess_{};
  double count_ = 0.0;
};

}  // namespace dermis::learn::recognition
