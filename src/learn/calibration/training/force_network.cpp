// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/training/force_network.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::learn::calibration {
namespace {

// Standard deviations of the prior. A hidden unit bends ln(newtons) by about one over the range of its inputs. The
// power law and a temperature law from many temperatures are nearly free. Rubbers drift by 0.2 to 1 %/C.
constexpr double kHiddenDeviation = 1.5;
constexpr double kDirectDeviation = 5.0;
constexpr double kDeviationPerCelsius = 0.02;
constexpr double kHeldDeviation = 1e-4;

double power_deviation(bool is_exponent, PowerPrior power) {
  const bool is_held = power == PowerPrior::held || (!is_exponent && power == PowerPrior::straight);
  return is_held ? kHeldDeviation : kDirectDeviation;
}

double deviation(const touch::network::PerceptronShape& shape, std::size_t parameter, const NetworkPrior& prior) {
  if (parameter == shape.direct_weight(0)) return power_deviation(true, prior.power);
  if (parameter == shape.direct_weight(1)) return power_deviation(false, prior.power);
  const std::size_t temperature = touch::fusion::kInputsWithTemperature - 1;
  if (shape.inputs <= temperature) return kHiddenDeviation;
  if (prior.temperature == TemperaturePrior::free) {
    return parameter == shape.direct_weight(temperature) ? kDirectDeviation : kHiddenDeviation;
  }
  if (parameter == shape.direct_weight(temperature)) return kDeviationPerCelsius * prior.half_span_celsius;
  for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
    if (parameter == shape.weight(unit, temperature)) return kHeldDeviation;
  }
  return kHiddenDeviation;
}

}  // namespace

ForceNetwork::Inputs ForceNetwork::inputs(double excess_siemens, double temperature) const noexcept {
  const double share = excess_siemens / reference_siemens;
  return {std::log(share), share - 1.0, temperature};
}

double ForceNetwork::log_newtons(const Inputs& inputs) const noexcept {
  return touch::network::output(shape, parameters, std::span(inputs).first(shape.inputs));
}

touch::network::PerceptronShape force_shape(bool uses_temperature, std::size_t hidden) noexcept {
  const std::size_t inputs =
      uses_temperature ? touch::fusion::kInputsWithTemperature : touch::fusion::kInputsWithTemperature - 1;
  return {inputs, hidden, 2};
}

std::vector<double> random_start(const touch::network::PerceptronShape& shape, double newtons_at_reference,
                                 Random& random) {
  constexpr double kLeastWeight = 0.02;
  const auto positive = [&](double deviation) {
    return std::log(std::max(std::abs(deviation * random.normal()), kLeastWeight));
  };
  std::vector<double> free(shape.parameter_count(), 0.0);
  for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
    free[shape.bias(unit)] = random.normal();
    for (std::size_t input = 0; input < shape.inputs; ++input) {
      const std::size_t k = shape.weight(unit, input);
      free[k] = touch::network::monotone::is_positive(shape, k) ? positive(1.0) : random.normal();
    }
    free[shape.output_weight(unit)] = positive(0.1);
  }
  free[shape.output_bias()] = std::log(newtons_at_reference);
  free[shape.direct_weight(0)] = 0.0;  // a power of exp(0) = 1
  free[shape.direct_weight(1)] = std::log(kLeastWeight);
  return free;
}

void prior_residuals(const touch::network::PerceptronShape& shape, std::span<const double> parameters,
                     const NetworkPrior& prior, double scale, std::span<double> residuals,
                     std::span<double> slopes) noexcept {
  for (std::size_t k = 0; k < shape.parameter_count(); ++k) {
    const bool is_level = k == shape.output_bias();
    const double centre = k == shape.direct_weight(0) ? 1.0 : 0.0;
    const double weight = is_level ? 0.0 : scale / deviation(shape, k, prior);
    residuals[k] = weight * (parameters[k] - centre);
    slopes[k] = weight * (touch::network::monotone::is_positive(shape, k) ? parameters[k] : 1.0);
  }
}

}  // namespace dermis::learn::calibration
