// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dermis/paper/network_shape.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::paper {

/// The paper's start for one network N-N-N-1 whose inputs form a grid, eq. (7) to (15). It has three layers of
/// log_sigmoid neurons, of which the first two have one neuron at each position of the grid. A neuron is connected to
/// its own position with omega_A, to its neighbours with omega_B, to the rest with omega_C. With all inputs at 0 every
/// output is 0.25, with all at the maximum 0.75.
///
/// The meaning of N: the text counts 2 N^3 + N^2 connections and 33,751,296 unknowns with N = 256 for a 16 x 16 array.
/// There N is the number of inputs, and the count is that of N networks N-N-N-1. Eq. (7) to (15) have N^2 - 9 others
/// beside a position and its eight neighbours, and N^2 connections to the output. There N is the side of the array. So
/// N^2 of the equations is `inputs` here.
///
/// The solution of the printed systems, with ln 3 = 1.0986:
///   eq. (11): omega_A = 2 ln 3 / x_max, omega_B = omega_C = 0, theta = -ln 3;
///   eq. (12): omega_A = 4 ln 3,         omega_B = omega_C = 0, theta = -2 ln 3;
///   eq. (15): omega   = 4 ln 3 / N^2,                          theta = -2 ln 3.
/// For eq. (9) less eq. (10) is x_max omega_C = 0, and eq. (7) less eq. (8) is then 8 x_max omega_B = 0. A unit far
/// away must not be seen, and all units together must do no more than the own one. A network so started connects each
/// position with itself only; what it knows of its neighbours begins with the small random numbers. The text before eq.
/// (12) has the replacement the wrong way round. As its rows are printed, eq. (12) is eq. (11) with 0.25 in place of 0
/// and 0.75 in place of x_max. (15) follows from (13) and (14), (11) from (7) to (10).
///
/// Two things are added to the paper. Positions at an edge have five neighbours and in a corner three. The systems are
/// solved with these numbers, so each neuron meets the same conditions. A grid too small to have a rest or neighbours
/// has no omega_C or omega_B. Their equations are then left out.

/// The connections of a neuron.
struct GridWeights {
  double same = 0.0;       ///< omega_A
  double neighbour = 0.0;  ///< omega_B
  double other = 0.0;      ///< omega_C
  double threshold = 0.0;  ///< theta
};

/// Eq. (7) to (11) for a neuron of the first layer with this many neighbours (the paper's 8) and others (its N^2 - 9).
/// Inputs are 0 ... max_input, > 0. No neighbours means no others either.
[[nodiscard]] GridWeights first_layer_weights(std::size_t neighbours, std::size_t others, double max_input);

/// Eq. (12) for a neuron of the second layer; its inputs are 0.25 ... 0.75.
[[nodiscard]] GridWeights second_layer_weights(std::size_t neighbours, std::size_t others);

struct OutputWeights {
  double weight = 0.0;     ///< omega, the same for all connections.
  double threshold = 0.0;  ///< theta
};

/// Eq. (13) to (15) for the output neuron; inputs >= 1.
[[nodiscard]] OutputWeights output_layer_weights(std::size_t inputs);

struct StructuredStart {
  std::size_t rows = 1;  ///< rows * cols is 1 ... 4,096.
  std::size_t cols = 1;
  double max_input = 1.0;  ///< x_max, > 0
  /// The paper's small random number, which is added to each weight and threshold. It is uniform in +-randomness, >= 0;
  /// on the weights of the first layer in +-randomness / max_input.
  double randomness = 0.01;
  std::uint64_t seed = 1;

  /// N-N-N-1, N = rows * cols.
  [[nodiscard]] NetworkShape shape() const;

  /// Names the first field that is out of its range.
  [[nodiscard]] Status validate() const;
};

/// The parameters of the network started, [start.shape().parameter_count()]; position [row, col] of the grid is input
/// and neuron row * cols + col. `start` must be valid. Thread-safe.
template <std::floating_point Real>
[[nodiscard]] std::vector<Real> structured_start(const StructuredStart& start);

}  // namespace dermis::paper
