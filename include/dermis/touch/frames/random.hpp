// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>

namespace dermis {

/// Seeded random numbers (xoshiro256++, seeded with splitmix64; Blackman and Vigna, 2019). The same seed gives the
/// same numbers on every machine and compiler. Not thread-safe: one generator per thread or per task.
class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept;

  /// An independent generator for task `stream`: results do not depend on the order in which tasks run.
  [[nodiscard]] static Random stream(std::uint64_t seed, std::uint64_t stream) noexcept;

  [[nodiscard]] std::uint64_t bits() noexcept;
  [[nodiscard]] double uniform() noexcept;                             ///< [0, 1)
  [[nodiscard]] double uniform(double low, double high) noexcept;      ///< [low, high)
  [[nodiscard]] double log_uniform(double low, double high) noexcept;  ///< density ~ 1/x on [low, high), low > 0
  [[nodiscard]] double normal() noexcept;                              ///< mean 0, standard deviation 1
  [[nodiscard]] std::uint64_t below(std::uint64_t bound) noexcept;     ///< 0 ... bound - 1, 1 <= bound <= 2^32

 private:
  std::uint64_t state_[4];
  double spare_normal_ = 0.0;
  bool has_spare_normal_ = false;
};

}  // namespace dermis
