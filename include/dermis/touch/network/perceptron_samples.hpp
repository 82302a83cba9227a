// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/touch/network/perceptron.hpp"

namespace dermis::touch::network {

struct SamplesView;

/// What of a perceptron y is compared with the target of a sample.
enum class Estimate : std::uint8_t {
  output,              ///< y(x)
  sum_of_exponentials  ///< sum_i g_i exp(y(x_i)) over the terms of the sample, which has any number of them.
};

/// Samples to train one perceptron on. The residual of each is weight * (estimate - target). Samples stand side by side
/// in SIMD lanes: double precision, Highway. Sums are added up in an order that the width of the lanes does not change.
/// What is const is thread-safe.
class PerceptronSamples {
 public:
  /// `terms`: how many each sample has [samples]. All that is set below is zero.
  PerceptronSamples(std::size_t inputs, Estimate estimate, std::span<const std::size_t> terms);

  void set_target(std::size_t sample, double target, double weight);
  void set_input(std::size_t sample, std::size_t term, std::span<const double> x);
  void set_factor(std::size_t sample, std::size_t term, double factor);

  [[nodiscard]] std::size_t count() const noexcept { return slot_.size(); }

  /// Half the sum of squared residuals.
  [[nodiscard]] double error(const PerceptronShape& shape, std::span<const double> parameters) const;

  /// The gradient of the error [n] and the lower triangle of J^T J [n, n], for J = d residual / d parameter.
  void linearise(const PerceptronShape& shape, std::span<const double> parameters, std::span<double> gradient,
                 std::span<double> normal) const;

  /// The residuals [samples], and J [samples, n] where it is not empty.
  void residuals(const PerceptronShape& shape, std::span<const double> parameters, std::span<double> residuals,
                 std::span<double> jacobian) const;

 private:
  [[nodiscard]] SamplesView view(const PerceptronShape& shape, std::span<const double> parameters) const;
  [[nodiscard]] std::size_t place(std::size_t sample, std::size_t term) const;

  std::size_t inputs_;
  Estimate estimate_;
  std::vector<std::size_t> slot_;  // of each sample: those of a block of lanes have about the same number of terms
  std::vector<std::size_t> first_term_;  // of each block, and behind the last one
  std::vector<double> x_;                // [terms of blocks, inputs, lanes]
  std::vector<double> factors_;          // [terms of blocks, lanes]
  std::vector<double> targets_;          // [blocks, lanes]
  std::vector<double> weights_;          // [blocks, lanes]
};

}  // namespace dermis::touch::network
