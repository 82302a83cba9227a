// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/structured_start.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "dermis/paper/feed_forward.hpp"

namespace dermis::paper {
namespace {

using Numbers = std::vector<double>;

const double kLn3 = std::log(3.0);

/// Neighbours and others: of a centre, an edge and a corner of an 16 x 16 array, and of other grids.
struct Place {
  double neighbours;
  double others;
};
const Place kPlaces[] = {{8, 247}, {5, 250}, {3, 252}, {8, 7}, {5, 6}, {3, 12}, {2, 1}, {1, 1}};

GridWeights first(const Place& place, double x_max) {
  return first_layer_weights(static_cast<std::size_t>(place.neighbours), static_cast<std::size_t>(place.others), x_max);
}

TEST(StructuredStart, the_first_layer_satisfies_equations_7_to_10_as_printed) {
  for (const Place& place : kPlaces) {
    for (const double x_max : {1e-6, 1.0, 5.0, 4095.0}) {
      SCOPED_TRACE(testing::Message() << place.neighbours << " neighbours, x_max " << x_max);
      const GridWeights w = first(place, x_max);
      const double b = place.neighbours;
      const double c = place.others;  // N^2 - 9, or what is left beside fewer neighbours
      EXPECT_NEAR(x_max * w.same + b * x_max * w.neighbour + c * x_max * w.other + w.threshold, kLn3, 1e-12);  // (7)
      EXPECT_NEAR(x_max * w.same + b * 0.0 * w.neighbour + c * 0.0 * w.other + w.threshold, kLn3, 1e-12);      // (8)
      EXPECT_NEAR(0.0 * w.same + b * 0.0 * w.neighbour + (c - 1.0) * 0.0 * w.other + w.other * x_max + w.threshold,
                  -kLn3, 1e-12);                                                                          // (9)
      EXPECT_NEAR(0.0 * w.same + b * 0.0 * w.neighbour + c * 0.0 * w.other + w.threshold, -kLn3, 1e-12);  // (10)
    }
  }
}

TEST(StructuredStart, the_second_layer_satisfies_the_rows_of_equation_12_as_printed) {
  for (const Place& place : kPlaces) {
    SCOPED_TRACE(testing::Message() << place.neighbours << " neighbours");
    const GridWeights w =
        second_layer_weights(static_cast<std::size_t>(place.neighbours), static_cast<std::size_t>(place.others));
    const double b = place.neighbours;
    const double c = place.others;
    EXPECT_NEAR(0.75 * w.same + b * 0.75 * w.neighbour + c * 0.75 * w.other + w.threshold, kLn3, 1e-12);
    EXPECT_NEAR(0.75 * w.same + b * 0.25 * w.neighbour + c * 0.25 * w.other + w.threshold, kLn3, 1e-12);
    EXPECT_NEAR(0.25 * w.same + b * 0.25 * w.neighbour + ((c - 1.0) * 0.25 + 0.75) * w.other + w.threshold, -kLn3,
                1e-12);
    EXPECT_NEAR(0.25 * w.same + b * 0.25 * w.neighbour + c * 0.25 * w.other + w.threshold, -kLn3, 1e-12);
  }
}

TEST(StructuredStart, the_output_layer_satisfies_equations_13_and_14_as_printed) {
  for (const double n_square : {1.0, 4.0, 64.0, 256.0, 4096.0}) {
    const OutputWeights w = output_layer_weights(static_cast<std::size_t>(n_square));
    EXPECT_NEAR(n_square * 0.75 * w.weight + w.threshold, kLn3, 1e-12);
    EXPECT_NEAR(n_square * 0.25 * w.weight + w.threshold, -kLn3, 1e-12);
  }
}

TEST(StructuredStart, the_solutions_are_those_of_the_header) {
  for (const Place& place : kPlaces) {
    const GridWeights w = first(place, 5.0);
    EXPECT_NEAR(w.same, 2.0 * kLn3 / 5.0, 1e-12);
    EXPECT_NEAR(w.neighbour, 0.0, 1e-12);
    EXPECT_NEAR(w.other, 0.0, 1e-12);
    EXPECT_NEAR(w.threshold, -kLn3, 1e-12);
    const GridWeights second =
        second_layer_weights(static_cast<std::size_t>(place.neighbours), static_cast<std::size_t>(place.others));
    EXPECT_NEAR(second.same, 4.0 * kLn3, 1e-12);
    EXPECT_NEAR(second.neighbour, 0.0, 1e-12);
    EXPECT_NEAR(second.other, 0.0, 1e-12);
    EXPECT_NEAR(second.threshold, -2.0 * kLn3, 1e-12);
  }
  EXPECT_NEAR(output_layer_weights(256).weight, 4.0 * kLn3 / 256.0, 1e-14);
  EXPECT_NEAR(output_layer_weights(256).threshold, -2.0 * kLn3, 1e-12);
}

/// The outputs of all layers: the network is cut off above each.
Numbers outputs_of_layer(const StructuredStart& start, const Numbers& parameters, std::size_t layer,
                         const Numbers& inputs) {
  NetworkShape shape = start.shape();
  shape.layers.resize(layer + 1);
  FeedForward<double> network(shape);
  Numbers outputs(shape.outputs());
  network.evaluate(std::span(parameters).first(shape.parameter_count()), inputs, outputs);
  return outputs;
}

struct Grid {
  std::size_t rows;
  std::size_t cols;
};
const Grid kGrids[] = {{1, 1}, {1, 2}, {2, 1}, {1, 3}, {2, 2}, {2, 3}, {3, 3}, {1, 7}, {4, 4}, {5, 3}, {8, 8}, {6, 11}};

TEST(StructuredStart, each_neuron_gives_a_quarter_unexcited_and_three_quarters_excited) {
  for (const Grid& grid : kGrids) {
    SCOPED_TRACE(testing::Message() << grid.rows << " x " << grid.cols);
    const StructuredStart start{.rows = grid.rows, .cols = grid.cols, .max_input = 3.0, .randomness = 0.0};
    ASSERT_TRUE(start.validate());
    const std::size_t n = grid.rows * grid.cols;
    const Numbers parameters = structured_start<double>(start);
    ASSERT_EQ(parameters.size(), n * (n + 1) * 2 + n + 1);
    for (std::size_t layer = 0; layer < 3; ++layer) {
      for (const double output : outputs_of_layer(start, parameters, layer, Numbers(n, 0.0))) {
        EXPECT_NEAR(output, 0.25, 1e-12);
      }
      for (const double output : outputs_of_layer(start, parameters, layer, Numbers(n, 3.0))) {
        EXPECT_NEAR(output, 0.75, 1e-12);
      }
    }
    for (std::size_t excited = 0; excited < n; ++excited) {
      Numbers inputs(n, 0.0);
      inputs[excited] = 3.0;
      for (const std::size_t layer : {0U, 1U}) {
        const Numbers outputs = outputs_of_layer(start, parameters, layer, inputs);
        for (std::size_t neuron = 0; neuron < n; ++neuron) {
          EXPECT_NEAR(outputs[neuron], neuron == excited ? 0.75 : 0.25, 1e-12);
        }
      }
      // The output neuron has the sum of all: one of N units is a share 1/N of the way from -ln 3 to ln 3.
      const double sum = -kLn3 + 2.0 * kLn3 / static_cast<double>(n);
      EXPECT_NEAR(outputs_of_layer(start, parameters, 2, inputs)[0], 1.0 / (1.0 + std::exp(-sum)), 1e-12);
    }
  }
}

TEST(StructuredStart, adds_a_small_random_number_to_everything) {
  StructuredStart start{.rows = 4, .cols = 5, .max_input = 50.0, .randomness = 0.0, .seed = 3};
  const Numbers bare = structured_start<double>(start);
  start.randomness = 0.02;
  const Numbers drawn = structured_start<double>(start);
  double greatest_first = 0.0;
  double greatest_above = 0.0;
  for (std::size_t k = 0; k < bare.size(); ++k) {
    EXPECT_NE(drawn[k], bare[k]) << k;
    double& greatest = k < start.shape().thresholds(0) ? greatest_first : greatest_above;
    greatest = std::max(greatest, std::abs(drawn[k] - bare[k]));
  }
  EXPECT_LE(greatest_first, 0.02 / 50.0 + 1e-15);  // the inputs are 50 times as large
  EXPECT_GT(greatest_first, 0.018 / 50.0);
  EXPECT_LE(greatest_above, 0.02 + 1e-15);
  EXPECT_GT(greatest_above, 0.018);
  EXPECT_EQ(structured_start<double>(start), drawn);
  start.seed = 4;
  EXPECT_NE(structured_start<double>(start), drawn);
}

/// The paper's count for a 16 x 16 array, one network a taxel.
TEST(StructuredStart, the_bank_of_the_paper_has_its_33751296_unknowns) {
  const StructuredStart start{.rows = 16, .cols = 16};
  EXPECT_EQ(start.shape().describe(), "256-256-256-1");
  EXPECT_EQ(256 * start.shape().parameter_count(), 33'751'296U);
  EXPECT_EQ(structured_start<float>(start).size(), start.shape().parameter_count());
}

TEST(StructuredStart, refuses_what_is_out_of_range) {
  const auto message = [](const StructuredStart& start) {
    const Status valid = start.validate();
    return valid ? "accepted" : valid.error().message;
  };
  EXPECT_EQ(message({.rows = 64, .cols = 64}), "accepted");
  const std::size_t most = std::numeric_limits<std::size_t>::max();
  for (const Grid& grid : {Grid{0, 4}, Grid{4, 0}, Grid{64, 65}, Grid{most, most}, Grid{most, 1}}) {
    EXPECT_EQ(message({.rows = grid.rows, .cols = grid.cols}), "structured start: rows * cols must be 1 to 4096");
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {0.0, -1.0, nan, 1.0 / 0.0}) {
    EXPECT_EQ(message({.max_input = value}), "structured start: max_input must be greater than 0");
  }
  for (const double value : {-1e-3, nan, 1.0 / 0.0}) {
    EXPECT_EQ(message({.randomness = value}), "structured start: randomness must be at least 0");
  }
}

}  // namespace
}  // namespace dermis::paper
