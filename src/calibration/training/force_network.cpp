// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/training/force_network.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::calibration {
namespace {

// Standard deviations of the prior: a hidden unit bends ln(newtons) by about one over the range of its inputs; the
// power law and the linear temperature term are left nearly free.
constexpr double kHiddenDeviation = 1.5;
constexpr double kDirectDeviation = 5.0;
constexpr double kHeldDeviation = 1e-4;

}  // namespace

ForceNetwork::Inputs ForceNetwork::inputs(double excess_siemens, double temperature) const noexcept {
  const double share = excess_siemens / reference_siemens;
  return {std::log(share), share - 1.0, temperature};
}

double ForceNetwork::log_newtons(const Inputs& inputs, std::span<double> gradient) const noexcept {
  const std::span<const double> x(inputs.data(), shape.inputs);
  if (gradient.empty()) return network::output(shape, parameters, x);
  const double y = network::output_and_gradient(shape, parameters, x, gradient);
  network::monotone::chain_gradient(shape, parameters, gradient);
  return y;
}

network::PerceptronShape force_shape(bool uses_temperature, std::size_t hidden) noexcept {
  const std::size_t inputs = uses_temperature ? fusion::kInputsWithTemperature : fusion::kInputsWithTemperature - 1;
  return {inputs, hidden, 2};
}

std::vector<double> random_start(const network::PerceptronShape& shape, double newtons_at_reference, Random& random) {
  constexpr double kLeastWeight = 0.02;
  const auto positive = [&](double deviation) {
    return std::log(std::max(std::abs(deviation * random.normal()), kLeastWeight));
  };
  std::vector<double> free(shape.parameter_count(), 0.0);
  for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
    free[shape.bias(unit)] = random.normal();
    for (std::size_t input = 0; input < shape.inputs; ++input) {
      const std::size_t k = shape.weight(unit, input);
      free[k] = network::monotone::is_positive(shape, k) ? positive(1.0) : random.normal();
    }
    free[shape.output_weight(unit)] = positive(0.1);
  }
  free[shape.output_bias()] = std::log(newtons_at_reference);
  free[shape.direct_weight(0)] = 0.0;  // a power of exp(0) = 1
  free[shape.direct_weight(1)] = std::log(kLeastWeight);
  return free;
}

void prior_residuals(const ForceNetwork& network, double scale, std::span<double> residuals, std::span<double> jacobian,
                     std::size_t columns, PowerPrior power) noexcept {
  const network::PerceptronShape& shape = network.shape;
  for (std::size_t k = 0; k < shape.parameter_count(); ++k) {
    const bool is_level = k == shape.output_bias();
    const bool is_exponent = k == shape.direct_weight(0);
    const bool is_bend = k == shape.direct_weight(1);
    const double centre = is_exponent ? 1.0 : 0.0;
    const bool is_held = (is_exponent && power == PowerPrior::held) || (is_bend && power != PowerPrior::free);
    const double of_direct = is_held ? kHeldDeviation : kDirectDeviation;
    const double deviation = k >= shape.direct_weight(0) ? of_direct : kHiddenDeviation;
    const double weight = is_level ? 0.0 : scale / deviation;
    const double slope = network::monotone::is_positive(shape, k) ? network.parameters[k] : 1.0;
    residuals[k] = weight * (network.parameters[k] - centre);
    if (jacobian.empty()) continue;
    const std::span<double> row = jacobian.subspan(k * columns, columns);
    std::fill(row.begin(), row.end(), 0.0);
    row[k] = weight * slope;
  }
}

}  // namespace dermis::calibration
