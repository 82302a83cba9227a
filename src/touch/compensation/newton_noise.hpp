// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "touch/compensation/dense_inverse.hpp"
#include "touch/compensation/newton_equations.hpp"
#include "touch/compensation/scaled_circuit.hpp"

namespace dermis::touch::compensation {

/// The effect of an ohm of every driver on the readings, and the possible errors of drivers.
class DriverErrors {
 public:
  /// None where the drivers are exact or their errors are not counted.
  DriverErrors(const ArrayDescription& array, bool are_counted);

  /// At the point where `equations` were set up.
  void find_slopes(ScaledCircuit& circuit, const NewtonEquations& equations) noexcept;

  [[nodiscard]] const std::vector<double>& ohm() const noexcept { return ohm_; }
  [[nodiscard]] double correlation() const noexcept { return correlation_; }
  /// d x of a reading / d ohm [taxels, driven lines].
  [[nodiscard]] const std::vector<double>& slope() const noexcept { return slope_; }
  [[nodiscard]] std::size_t drivers() const noexcept { return ohm_.size(); }

 private:
  std::vector<double> ohm_;  // [driven lines]
  double correlation_;
  std::vector<double> slope_;
};

/// The variance of every taxel from the noise of its readings and the errors of the drivers.
///
/// Let B = (d x / d ratio) J (d siemens / d x). In units of x the variance is the sum of squares of each row of
/// B^-1 (d x / d ratio). A driver that is wrong by s moves all taxels by -B^-1 (d x / d ohm) s, with the readings
/// fixed.
class NewtonNoise {
 public:
  NewtonNoise() = default;
  NewtonNoise(const NewtonNoise&) = delete;
  NewtonNoise& operator=(const NewtonNoise&) = delete;
  virtual ~NewtonNoise() = default;

  /// Adds to `variance`, over the squares of NewtonEquations::column_scale(). Allocates nothing.
  virtual void add_to(std::span<double> variance, double sigma_ratio) noexcept = 0;
};

/// Exact on small arrays, sampled on others, or where `options` say so. The arguments are to outlive it.
[[nodiscard]] std::unique_ptr<NewtonNoise> make_newton_noise(ScaledCircuit& circuit, NewtonEquations& equations,
                                                             const DriverErrors& errors,
                                                             const InversionOptions& options);

}  // namespace dermis::touch::compensation
