// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dermis::benchmarks::reference {
namespace {

using paper::NetworkShape;
using touch::network::Activation;

double activate(Activation activation, double sum) {
  switch (activation) {
    case Activation::log_sigmoid: return 1.0 / (1.0 + std::exp(-sum));
    case Activation::tanh: return std::tanh(sum);
    case Activation::relu: return std::max(sum, 0.0);
    case Activation::linear: return sum;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double slope(Activation activation, double output) {
  switch (activation) {
    case Activation::log_sigmoid: return output * (1.0 - output);
    case Activation::tanh: return 1.0 - output * output;
    case Activation::relu: return output > 0.0 ? 1.0 : 0.0;
    case Activation::linear: return 1.0;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The inputs and the outputs of each layer for one pattern.
std::vector<std::vector<double>> forward(const NetworkShape& shape, std::span<const double> parameters,
                                         std::span<const double> inputs) {
  std::vector<std::vector<double>> values{{inputs.begin(), inputs.end()}};
  for (std::size_t layer = 0; layer < shape.layers.size(); ++layer) {
    const std::vector<double>& below = values.back();
    std::vector<double> above(shape.layers[layer].units);
    for (std::size_t unit = 0; unit < above.size(); ++unit) {
      double sum = parameters[shape.thresholds(layer) + unit];
      for (std::size_t k = 0; k < below.size(); ++k) {
        sum += parameters[shape.weights(layer) + unit * below.size() + k] * below[k];
      }
      above[unit] = activate(shape.layers[layer].activation, sum);
    }
    values.push_back(std::move(above));
  }
  return values;
}

/// Adds the gradient of one pattern; `back` is d error / d output.
void add_gradient(const NetworkShape& shape, std::span<const double> parameters,
                  const std::vector<std::vector<double>>& values, std::vector<double> back,
                  std::span<double> gradient) {
  for (std::size_t layer = shape.layers.size(); layer-- > 0;) {
    const std::vector<double>& below = values[layer];
    std::vector<double> back_below(below.size());
    for (std::size_t unit = 0; unit < back.size(); ++unit) {
      const double delta = back[unit] * slope(shape.layers[layer].activation, values[layer + 1][unit]);
      gradient[shape.thresholds(layer) + unit] += delta;
      for (std::size_t k = 0; k < below.size(); ++k) {
        const std::size_t weight = shape.weights(layer) + unit * below.size() + k;
        gradient[weight] += delta * below[k];
        back_below[k] += delta * parameters[weight];
      }
    }
    back = std::move(back_below);
  }
}

}  // namespace

std::vector<double> as_double(std::span<const float> values) {
  return {values.begin(), values.end()};
}

std::vector<double> outputs(const NetworkShape& shape, std::span<const double> parameters,
                            std::span<const double> inputs) {
  std::vector<double> all;
  for (std::size_t first = 0; first < inputs.size(); first += shape.inputs) {
    const std::vector<double> output = forward(shape, parameters, inputs.subspan(first, shape.inputs)).back();
    all.insert(all.end(), output.begin(), output.end());
  }
  return all;
}

ErrorAndGradient error_and_gradient(const NetworkShape& shape, std::span<const double> parameters,
                                    std::span<const double> inputs, std::span<const double> targets) {
  ErrorAndGradient sum{0.0, std::vector<double>(shape.parameter_count())};
  for (std::size_t p = 0; p * shape.inputs < inputs.size(); ++p) {
    const auto values = forward(shape, parameters, inputs.subspan(p * shape.inputs, shape.inputs));
    std::vector<double> back = values.back();
    for (std::size_t k = 0; k < back.size(); ++k) {
      back[k] -= targets[p * shape.outputs() + k];
      sum.error += 0.5 * back[k] * back[k];
    }
    add_gradient(shape, parameters, values, std::move(back), sum.gradient);
  }
  return sum;
}

std::vector<double> jacobian(const NetworkShape& shape, std::span<const double> parameters,
                             std::span<const double> inputs) {
  const std::size_t count = inputs.size() / shape.inputs;
  std::vector<double> rows(count * shape.parameter_count());
  for (std::size_t p = 0; p < count; ++p) {
    const auto values = forward(shape, parameters, inputs.subspan(p * shape.inputs, shape.inputs));
    add_gradient(shape, parameters, values, {1.0},
                 std::span(rows).subspan(p * shape.parameter_count(), shape.parameter_count()));
  }
  return rows;
}

void solve(std::span<double> matrix, std::span<double> vector) {
  const std::size_t n = vector.size();
  const auto at = [&](std::size_t row, std::size_t col) -> double& { return matrix[row * n + col]; };
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t col = 0; col <= row; ++col) {
      for (std::size_t k = 0; k < col; ++k) at(row, col) -= at(row, k) * at(col, k);
      at(row, col) = row == col ? std::sqrt(at(row, row)) : at(row, col) / at(col, col);
    }
  }
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t k = 0; k < row; ++k) vector[row] -= at(row, k) * vector[k];
    vector[row] /= at(row, row);
  }
  for (std::size_t row = n; row-- > 0;) {
    for (std::size_t k = row + 1; k < n; ++k) vector[row] -= at(k, row) * vector[k];
    vector[row] /= at(row, row);
  }
}

double max_deviation(std::span<const double> values, std::span<const double> expected) {
  double worst = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double deviation = std::fabs(values[k] - expected[k]);
    if (!std::isfinite(deviation)) return std::numeric_limits<double>::infinity();
    worst = std::fmax(worst, deviation);
  }
  return worst;
}

}  // namespace dermis::benchmarks::reference
