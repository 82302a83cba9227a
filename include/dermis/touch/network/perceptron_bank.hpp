// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/touch/network/perceptron.hpp"

namespace dermis::touch::network {

/// Many independent perceptrons of one shape, evaluated side by side in the SIMD lanes. Single precision, Highway; the
/// absolute error of a sigmoid is below 1e-6. Immutable after construction; evaluate() is thread-safe and allocates
/// nothing.
class PerceptronBank {
 public:
  PerceptronBank() = default;

  /// `parameters` has the shape [parameter_count, networks].
  PerceptronBank(const PerceptronShape& shape, std::size_t networks, std::span<const float> parameters);

  [[nodiscard]] std::size_t network_count() const noexcept { return networks_; }

  /// inputs [inputs, networks] -> outputs [networks].
  void evaluate(std::span<const float> inputs, std::span<float> outputs) const noexcept;

  /// The same, and d output / d input in `gradient` [inputs, networks]: the backward pass to the inputs.
  void evaluate(std::span<const float> inputs, std::span<float> outputs, std::span<float> gradient) const noexcept;

 private:
  PerceptronShape shape_;
  std::size_t networks_ = 0;
  std::vector<float> parameters_;
};

}  // namespace dermis::touch::network
