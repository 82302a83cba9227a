// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// What this machine can do at most, measured at the moment of the call, within a few milliseconds.
namespace dermis::benchmarks {

/// Multiplications and additions a second in independent fused multiply-adds that stay in registers, of all threads
/// together. Real: float or double.
template <typename Real>
[[nodiscard]] double operations_per_second(int threads);

enum class Function { float_sigmoid, double_sigmoid, float_tanh };

/// Of one element of an array that stays in the first-level cache, by vector code.
[[nodiscard]] double seconds_of(Function function);

/// The vector code itself, for the peers that have no sigmoid of their own.
void sigmoid_in_place(std::span<float> values);

/// Memory in huge pages, where the system has them.
class HugePages {
 public:
  explicit HugePages(std::size_t floats);
  HugePages(const HugePages&) = delete;
  HugePages& operator=(const HugePages&) = delete;
  ~HugePages();

  [[nodiscard]] std::span<float> values() const { return {data_, floats_}; }

 private:
  std::size_t floats_;
  std::size_t bytes_;
  float* data_;
};

/// Reads all values once and adds them up.
[[nodiscard]] float sum(std::span<const float> values, int threads);

}  // namespace dermis::benchmarks
