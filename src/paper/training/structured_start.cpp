// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/structured_start.hpp"

#include <Eigen/Dense>
#include <cassert>
#include <cmath>

#include "dermis/touch/frames/random.hpp"

namespace dermis::paper {
namespace {

constexpr std::size_t kMaxInputs = 4096;

const double kHighSum = std::log(3.0);  // of which eq. (3) makes 0.75
const double kLowSum = -kHighSum;       // and 0.25

/// Eq. (11), with inputs of `low` where it has 0 and `high` where it has x_max, which makes eq. (12) of it.
GridWeights solve(std::size_t neighbours, std::size_t others, double low, double high) {
  assert(neighbours > 0 || others == 0);
  const auto b = static_cast<double>(neighbours);
  const auto c = static_cast<double>(others);
  Eigen::Matrix4d matrix;
  matrix << high, b * high, c * high, 1.0,        // eq. (7): all are excited
      high, b * low, c * low, 1.0,                // eq. (8): the own position
      low, b * low, (c - 1.0) * low + high, 1.0,  // eq. (9): one far away
      low, b * low, c * low, 1.0;                 // eq. (10): none
  Eigen::Vector4d sums(kHighSum, kHighSum, kLowSum, kLowSum);
  const auto leave_out = [&](Eigen::Index row, Eigen::Index unknown) {
    matrix.row(row) = Eigen::RowVector4d::Unit(unknown);
    sums[row] = 0.0;
  };
  if (neighbours == 0) leave_out(0, 1);
  if (others == 0) leave_out(2, 2);
  const Eigen::Vector4d solution = matrix.fullPivLu().solve(sums);
  return {solution[0], solution[1], solution[2], solution[3]};
}

bool touch(std::size_t a, std::size_t b) {
  return a <= b + 1 && b <= a + 1;
}

/// Positions of a line of the grid that are `at` or next to it.
std::size_t span_around(std::size_t at, std::size_t length) {
  return 1 + static_cast<std::size_t>(at > 0) + static_cast<std::size_t>(at + 1 < length);
}

/// A layer that has one neuron at each position and connects to all.
struct GridLayer {
  std::size_t rows;
  std::size_t cols;
  double* weights;
  double* thresholds;

  [[nodiscard]] std::size_t positions() const { return rows * cols; }

  [[nodiscard]] std::size_t neighbours(std::size_t position) const {
    return span_around(position / cols, rows) * span_around(position % cols, cols) - 1;
  }

  void set(std::size_t neuron, const GridWeights& values) const {
    for (std::size_t position = 0; position < positions(); ++position) {
      const bool near = touch(neuron / cols, position / cols) && touch(neuron % cols, position % cols);
      const double distant = near ? values.neighbour : values.other;
      weights[neuron * positions() + position] = position == neuron ? values.same : distant;
    }
    thresholds[neuron] = values.threshold;
  }
};

}  // namespace

GridWeights first_layer_weights(std::size_t neighbours, std::size_t others, double max_input) {
  assert(max_input > 0.0);
  return solve(neighbours, others, 0.0, max_input);
}

GridWeights second_layer_weights(std::size_t neighbours, std::size_t others) {
  return solve(neighbours, others, 0.25, 0.75);
}

OutputWeights output_layer_weights(std::size_t inputs) {
  assert(inputs > 0);
  const auto n = static_cast<double>(inputs);
  Eigen::Matrix2d matrix;
  matrix << n * 0.75, 1.0,  // eq. (13)
      n * 0.25, 1.0;        // eq. (14)
  const Eigen::Vector2d solution = matrix.fullPivLu().solve(Eigen::Vector2d(kHighSum, kLowSum));
  return {solution[0], solution[1]};
}

NetworkShape StructuredStart::shape() const {
  const std::size_t inputs = rows * cols;
  return {inputs, {{inputs}, {inputs}, {1}}};
}

Status StructuredStart::validate() const {
  if (rows == 0 || cols == 0 || rows > kMaxInputs / cols) {
    return bad_input("structured start: rows * cols must be 1 to 4096");
  }
  if (!(max_input > 0.0) || !std::isfinite(max_input)) {
    return bad_input("structured start: max_input must be greater than 0");
  }
  if (!(randomness >= 0.0) || !std::isfinite(randomness)) {
    return bad_input("structured start: randomness must be at least 0");
  }
  return Done{};
}

template <std::floating_point Real>
std::vector<Real> structured_start(const StructuredStart& start) {
  assert(start.validate());
  const NetworkShape shape = start.shape();
  std::vector<double> parameters(shape.parameter_count());
  const auto layer = [&](std::size_t number) {
    return GridLayer{start.rows, start.cols, &parameters[shape.weights(number)], &parameters[shape.thresholds(number)]};
  };
  const GridLayer first = layer(0);
  const GridLayer second = layer(1);
  for (std::size_t neuron = 0; neuron < shape.inputs; ++neuron) {
    const std::size_t neighbours = first.neighbours(neuron);
    const std::size_t others = shape.inputs - 1 - neighbours;
    first.set(neuron, first_layer_weights(neighbours, others, start.max_input));
    second.set(neuron, second_layer_weights(neighbours, others));
  }
  const OutputWeights output = output_layer_weights(shape.inputs);
  std::fill(parameters.begin() + static_cast<std::ptrdiff_t>(shape.weights(2)), parameters.end(), output.weight);
  parameters.back() = output.threshold;

  Random random(start.seed);
  std::vector<Real> result(parameters.size());
  for (std::size_t k = 0; k < result.size(); ++k) {
    const double unit = k < shape.thresholds(0) ? start.max_input : 1.0;
    result[k] = static_cast<Real>(parameters[k] + random.uniform(-1.0, 1.0) * start.randomness / unit);
  }
  return result;
}

template std::vector<float> structured_start(const StructuredStart&);
template std::vector<double> structured_start(const StructuredStart&);

}  // namespace dermis::paper
