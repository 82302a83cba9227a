// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"
#include "dermis/touch/network/levenberg_marquardt.hpp"
#include "dermis/touch/network/perceptron.hpp"

namespace dermis::learn::calibration {

/// The network of one taxel, or of many: newtons = exp(perceptron(inputs)), as touch::fusion::ForceNetworks defines it.
struct ForceNetwork {
  touch::network::PerceptronShape shape;
  double reference_siemens = 1.0;
  double heaviest_siemens = 1.0;
  double heaviest_newtons = 0.0;
  double rms_error = 0.0;                              ///< Root mean square relative error on its own samples.
  std::vector<double> parameters;                      ///< [shape.parameter_count()]
  std::vector<touch::network::FittedResidual> fitted;  ///< ln(estimate / newtons) of each sample.

  using Inputs = std::array<double, touch::fusion::kInputsWithTemperature>;

  /// Inputs for an excess conductance > 0 [S] and a temperature normalised to about [-1, 1].
  [[nodiscard]] Inputs inputs(double excess_siemens, double temperature) const noexcept;

  [[nodiscard]] double log_newtons(const Inputs& inputs) const noexcept;
};

/// Two or three inputs, rising with conductance.
[[nodiscard]] touch::network::PerceptronShape force_shape(bool uses_temperature, std::size_t hidden) noexcept;

/// Free parameters to start from: newtons = newtons_at_reference * e / reference, and small random hidden units.
[[nodiscard]] std::vector<double> random_start(const touch::network::PerceptronShape& shape,
                                               double newtons_at_reference, Random& random);

/// How far the data determine the power law of conductance.
enum class PowerPrior {
  free,      ///< All of it.
  straight,  ///< Its exponent, but not how that changes with the load: forces on two levels.
  held,      ///< Nothing: the exponent is 1.
};

/// How far the data determine the effect of temperature.
enum class TemperaturePrior {
  free,  ///< How it changes the law of force and conductance.
  line,  ///< A factor on the force whose logarithm is a line: hidden units do not see temperature.
};

/// How far the data determine the law, for prior_residuals().
struct NetworkPrior {
  PowerPrior power = PowerPrior::free;
  TemperaturePrior temperature = TemperaturePrior::free;
  double half_span_celsius = 0.0;  ///< That an input of 1 is worth, where temperature is one.
};

/// A Gaussian prior on the parameters, as a residual for each. Hidden weights are about 0, the power of conductance
/// about 1, and the temperature coefficient about that of rubbers. Parameters that `prior` calls unknown hardly leave
/// their values. `scale`: standard deviation of a data residual. Fills residuals [parameter_count] and slopes
/// [parameter_count], d residual / d free parameter of the same place; the others are zero.
void prior_residuals(const touch::network::PerceptronShape& shape, std::span<const double> parameters,
                     const NetworkPrior& prior, double scale, std::span<double> residuals,
                     std::span<double> slopes) noexcept;

}  // namespace dermis::learn::calibration
