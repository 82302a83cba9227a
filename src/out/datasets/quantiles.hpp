// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace dermis::out::datasets {

/// Quantiles of any number of values, in a memory that does not grow with them. It counts how many lie in each of 1024
/// parts between two powers of two. A quantile is too near to 0 by at most 0.1 %; whole numbers below 2048 are exact.
class Quantiles {
 public:
  void add(float value);  ///< Finite.
  void add(const Quantiles& others);
  /// The smallest value that at least this share of the values do not exceed; 0 without values. `share`: 0 ... 1
  [[nodiscard]] double at(double share) const;

 private:
  std::vector<std::vector<std::uint64_t>> counts_;  ///< By sign and exponent, then by the part.
  std::uint64_t count_ = 0;
};

}  // namespace dermis::out::datasets
