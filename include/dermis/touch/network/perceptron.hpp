// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>

namespace dermis::touch::network {

/// A three-layer BP network (the paper's Fig. 8) with one output and direct connections from the inputs to it:
///
///   y = c + sum_i s_i x_i + sum_h v_h f(b_h + sum_i w_hi x_i),   f(z) = 1 / (1 + exp(-z))     eq. (3), (4) of the
///   paper
///
/// The output layer differs from the paper. It is linear (as in the paper's own Fig. 5), so the output needs no scaling
/// to (0, 1). The direct connections carry the linear part, so few hidden units are enough for the rest.
///
/// Parameters are one flat vector: for every hidden unit b_h, w_h0, w_h1, ...; then c; then v_0, v_1, ...; then s_0,
/// ...
struct PerceptronShape {
  std::size_t inputs = 1;         ///< >= 1
  std::size_t hidden = 1;         ///< 0 ... 64
  std::size_t rising_inputs = 0;  ///< The output rises with this many first inputs; 0 ... inputs. See monotone.

  [[nodiscard]] std::size_t parameter_count() const noexcept { return hidden * (inputs + 2) + 1 + inputs; }
  [[nodiscard]] std::size_t bias(std::size_t unit) const noexcept { return unit * (inputs + 1); }
  [[nodiscard]] std::size_t weight(std::size_t unit, std::size_t input) const noexcept {
    return bias(unit) + 1 + input;
  }
  [[nodiscard]] std::size_t output_bias() const noexcept { return hidden * (inputs + 1); }
  [[nodiscard]] std::size_t output_weight(std::size_t unit) const noexcept { return output_bias() + 1 + unit; }
  [[nodiscard]] std::size_t direct_weight(std::size_t input) const noexcept {
    return output_bias() + 1 + hidden + input;
  }

  bool operator==(const PerceptronShape&) const = default;
};

/// Logistic sigmoid, eq. (3).
[[nodiscard]] double sigmoid(double sum) noexcept;

/// The output y for the inputs x [inputs]. Thread-safe.
[[nodiscard]] double output(const PerceptronShape& shape, std::span<const double> parameters,
                            std::span<const double> x) noexcept;

/// The output y, and dy/dparameter in `gradient` [parameter_count]: one backward pass (Fig. 9). Thread-safe.
double output_and_gradient(const PerceptronShape& shape, std::span<const double> parameters, std::span<const double> x,
                           std::span<double> gradient) noexcept;

/// A perceptron whose output rises with its rising inputs everywhere, by construction. The weights w_hi and s_i of
/// these inputs, and the v_h if there are any, are exp() of free values. Training works on the free values.
/// `parameters` turns them into perceptron parameters. `chain_gradient` turns dy/dparameter into dy/dfree, in place.
/// Thread-safe.
namespace monotone {
/// Whether a parameter is the exp() of its free value.
[[nodiscard]] bool is_positive(const PerceptronShape& shape, std::size_t parameter) noexcept;
void parameters(const PerceptronShape& shape, std::span<const double> free, std::span<double> parameters) noexcept;
void chain_gradient(const PerceptronShape& shape, std::span<const double> parameters,
                    std::span<double> gradient) noexcept;
}  // namespace monotone

}  // namespace dermis::touch::network
