// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/network/perceptron.hpp"

#include <cassert>
#include <cmath>

namespace dermis::touch::network {
namespace {

double weighted_sum(const PerceptronShape& shape, std::span<const double> parameters, std::span<const double> x,
                    std::size_t unit) noexcept {
  double sum = parameters[shape.bias(unit)];
  for (std::size_t input = 0; input < shape.inputs; ++input) sum += parameters[shape.weight(unit, input)] * x[input];
  return sum;
}

double direct_output(const PerceptronShape& shape, std::span<const double> parameters,
                     std::span<const double> x) noexcept {
  double y = parameters[shape.output_bias()];
  for (std::size_t input = 0; input < shape.inputs; ++input) y += parameters[shape.direct_weight(input)] * x[input];
  return y;
}

}  // namespace

double sigmoid(double sum) noexcept {
  return 1.0 / (1.0 + std::exp(-sum));
}

double output(const PerceptronShape& shape, std::span<const double> parameters, std::span<const double> x) noexcept {
  assert(parameters.size() == shape.parameter_count() && x.size() == shape.inputs);
  double y = direct_output(shape, parameters, x);
  for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
    y += parameters[shape.output_weight(unit)] * sigmoid(weighted_sum(shape, parameters, x, unit));
  }
  return y;
}

double output_and_gradient(const PerceptronShape& shape, std::span<const double> parameters, std::span<const double> x,
                           std::span<double> gradient) noexcept {
  assert(parameters.size() == shape.parameter_count() && gradient.size() == parameters.size());
  double y = direct_output(shape, parameters, x);
  gradient[shape.output_bias()] = 1.0;
  for (std::size_t input = 0; input < shape.inputs; ++input) gradient[shape.direct_weight(input)] = x[input];
  for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
    const double activation = sigmoid(weighted_sum(shape, parameters, x, unit));
    const double v = parameters[shape.output_weight(unit)];
    y += v * activation;
    gradient[shape.output_weight(unit)] = activation;
    const double back = v * activation * (1.0 - activation);
    gradient[shape.bias(unit)] = back;
    for (std::size_t input = 0; input < shape.inputs; ++input) gradient[shape.weight(unit, input)] = back * x[input];
  }
  return y;
}

namespace monotone {

bool is_positive(const PerceptronShape& shape, std::size_t parameter) noexcept {
  if (shape.rising_inputs == 0) return false;
  if (parameter >= shape.direct_weight(0)) return parameter < shape.direct_weight(shape.rising_inputs);
  if (parameter >= shape.output_bias()) return parameter > shape.output_bias();
  const std::size_t place = parameter % (shape.inputs + 1);  // 0: the bias of the unit
  return place >= 1 && place <= shape.rising_inputs;
}

void parameters(const PerceptronShape& shape, std::span<const double> free, std::span<double> parameters) noexcept {
  assert(free.size() == shape.parameter_count() && parameters.size() == free.size());
  for (std::size_t k = 0; k < free.size(); ++k) parameters[k] = is_positive(shape, k) ? std::exp(free[k]) : free[k];
}

void chain_gradient(const PerceptronShape& shape, std::span<const double> parameters,
                    std::span<double> gradient) noexcept {
  if (shape.rising_inputs == 0) return;
  const auto chain = [&](std::size_t parameter) { gradient[parameter] *= parameters[parameter]; };
  for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
    for (std::size_t input = 0; input < shape.rising_inputs; ++input) chain(shape.weight(unit, input));
    chain(shape.output_weight(unit));
  }
  for (std::size_t input = 0; input < shape.rising_inputs; ++input) chain(shape.direct_weight(input));
}

}  // namespace monotone
}  // namespace dermis::touch::network
