// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/initialisation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace dermis::paper {
namespace {

using Numbers = std::vector<double>;

const NetworkShape kShape{3, {{40, Activation::log_sigmoid}, {30, Activation::tanh}, {20, Activation::linear}}};
const std::vector<InputRange> kRanges = {{-1.0, 1.0}, {0.0, 10.0}, {-5e-3, -1e-3}};

Numbers weights_of(const Numbers& parameters, std::size_t layer) {
  return {parameters.begin() + static_cast<std::ptrdiff_t>(kShape.weights(layer)),
          parameters.begin() + static_cast<std::ptrdiff_t>(kShape.thresholds(layer))};
}

Numbers thresholds_of(const Numbers& parameters, std::size_t layer) {
  return {parameters.begin() + static_cast<std::ptrdiff_t>(kShape.thresholds(layer)),
          parameters.begin() + static_cast<std::ptrdiff_t>(kShape.weights(layer + 1))};
}

/// Within +-range, near both ends, mean near 0 and mean square near range^2 / 3.
void expect_uniform(const Numbers& values, double range) {
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  EXPECT_GE(*least, -range);
  EXPECT_LE(*greatest, range);
  EXPECT_LT(*least, -0.9 * range);
  EXPECT_GT(*greatest, 0.9 * range);
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  const double square = std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / count;
  EXPECT_LT(std::abs(mean), 4.0 * range / std::sqrt(3.0 * count));  // four standard deviations
  EXPECT_NEAR(square / (range * range / 3.0), 1.0, 4.0 / std::sqrt(count));
}

TEST(Initialisation, the_same_seed_gives_the_same_numbers_and_another_seed_others) {
  EXPECT_EQ(uniform_start<float>(kShape, 0.5, 1), uniform_start<float>(kShape, 0.5, 1));
  EXPECT_NE(uniform_start<float>(kShape, 0.5, 1), uniform_start<float>(kShape, 0.5, 2));
  EXPECT_EQ(xavier_start<double>(kShape, 1), xavier_start<double>(kShape, 1));
  EXPECT_NE(xavier_start<double>(kShape, 1), xavier_start<double>(kShape, 2));
  EXPECT_EQ(nguyen_widrow_start<double>(kShape, kRanges, 1), nguyen_widrow_start<double>(kShape, kRanges, 1));
  EXPECT_NE(nguyen_widrow_start<double>(kShape, kRanges, 1), nguyen_widrow_start<double>(kShape, kRanges, 2));
}

TEST(Initialisation, single_precision_has_the_double_numbers_rounded) {
  const Numbers exact = nguyen_widrow_start<double>(kShape, kRanges, 4);
  const std::vector<float> rounded = nguyen_widrow_start<float>(kShape, kRanges, 4);
  ASSERT_EQ(rounded.size(), exact.size());
  for (std::size_t k = 0; k < exact.size(); ++k) EXPECT_EQ(rounded[k], static_cast<float>(exact[k]));
}

TEST(Initialisation, uniform_start_fills_the_range) {
  const Numbers parameters = uniform_start<double>(kShape, 0.25, 1);
  ASSERT_EQ(parameters.size(), kShape.parameter_count());
  expect_uniform(parameters, 0.25);
  EXPECT_EQ(uniform_start<double>(kShape, 0.0, 1), Numbers(kShape.parameter_count(), 0.0));
}

TEST(Initialisation, xavier_start_has_glorots_range_in_each_layer_and_no_thresholds) {
  const Numbers parameters = xavier_start<double>(kShape, 1);
  ASSERT_EQ(parameters.size(), kShape.parameter_count());
  expect_uniform(weights_of(parameters, 0), std::sqrt(6.0 / 43.0));
  expect_uniform(weights_of(parameters, 1), std::sqrt(6.0 / 70.0));
  expect_uniform(weights_of(parameters, 2), std::sqrt(6.0 / 50.0));
  for (std::size_t layer = 0; layer < 3; ++layer) {
    for (const double threshold : thresholds_of(parameters, layer)) EXPECT_EQ(threshold, 0.0);
  }
}

TEST(Initialisation, input_ranges_are_those_of_each_column) {
  const std::vector<float> inputs = {1.0F, 5.0F, -2.0F, 5.0F, 0.5F, 5.0F};
  const auto ranges = input_ranges(Samples<float>{3, inputs, {}, {}}, 2);
  ASSERT_EQ(ranges.size(), 2U);
  EXPECT_EQ(ranges[0].least, -2.0);
  EXPECT_EQ(ranges[0].greatest, 1.0);
  EXPECT_EQ(ranges[1].least, 5.0);
  EXPECT_EQ(ranges[1].greatest, 5.0);
}

/// The neurons of a layer as they are on inputs scaled to +-1, in shares of the active region: weights have the length
/// 0.7 S^(1/R), thresholds go evenly from minus to plus that length, with the sign of the first weight.
void expect_nguyen_widrow(const Numbers& weights, const Numbers& thresholds, const std::vector<InputRange>& ranges,
                          double half_width) {
  const std::size_t fan_in = ranges.size();
  const std::size_t units = thresholds.size();
  const double length = 0.7 * std::pow(static_cast<double>(units), 1.0 / static_cast<double>(fan_in));
  for (std::size_t unit = 0; unit < units; ++unit) {
    double square = 0.0;
    double threshold = thresholds[unit];
    for (std::size_t k = 0; k < fan_in; ++k) {
      const double weight = weights[unit * fan_in + k] * 0.5 * (ranges[k].greatest - ranges[k].least);
      square += weight * weight;
      threshold += weights[unit * fan_in + k] * 0.5 * (ranges[k].greatest + ranges[k].least);
    }
    EXPECT_NEAR(std::sqrt(square), half_width * length, 1e-9 * length);
    const double place = 2.0 * static_cast<double>(unit) / static_cast<double>(units - 1) - 1.0;
    const double sign = weights[unit * fan_in] > 0.0 ? 1.0 : -1.0;
    EXPECT_NEAR(threshold, half_width * length * place * sign, 1e-9 * length) << "unit " << unit;
  }
}

TEST(Initialisation, nguyen_widrow_start_spreads_the_active_regions_over_the_ranges) {
  const Numbers parameters = nguyen_widrow_start<double>(kShape, kRanges, 1);
  ASSERT_EQ(parameters.size(), kShape.parameter_count());
  expect_nguyen_widrow(weights_of(parameters, 0), thresholds_of(parameters, 0), kRanges, 4.0);
  expect_nguyen_widrow(weights_of(parameters, 1), thresholds_of(parameters, 1), std::vector<InputRange>(40, {0.0, 1.0}),
                       2.0);
  expect_uniform(weights_of(parameters, 2), std::sqrt(6.0 / 50.0));  // linear: as in xavier_start()
}

TEST(Initialisation, nguyen_widrow_start_points_everywhere) {
  const NetworkShape shape{2, {{400, Activation::tanh}}};
  const Numbers parameters = nguyen_widrow_start<double>(shape, std::vector<InputRange>(2), 1);
  int quadrants[4] = {};
  for (std::size_t unit = 0; unit < 400; ++unit) {
    ++quadrants[(parameters[2 * unit] > 0.0 ? 2 : 0) + (parameters[2 * unit + 1] > 0.0 ? 1 : 0)];
  }
  for (const int count : quadrants) EXPECT_NEAR(count, 100, 40);
}

TEST(Initialisation, nguyen_widrow_start_puts_a_single_neuron_in_the_middle) {
  const NetworkShape shape{1, {{1, Activation::tanh}}};
  const Numbers parameters = nguyen_widrow_start<double>(shape, {{{2.0, 6.0}}}, 1);
  EXPECT_NEAR(std::abs(parameters[0]), 2.0 * 0.7 / 2.0, 1e-12);
  EXPECT_NEAR(parameters[1] + 4.0 * parameters[0], 0.0, 1e-12);
}

TEST(Initialisation, nguyen_widrow_start_leaves_a_constant_input_out) {
  const NetworkShape shape{2, {{5, Activation::log_sigmoid}}};
  const Numbers parameters = nguyen_widrow_start<double>(shape, {{{3.0, 3.0}, {-1.0, 1.0}}}, 1);
  for (std::size_t unit = 0; unit < 5; ++unit) {
    EXPECT_EQ(parameters[2 * unit], 0.0);
    EXPECT_NE(parameters[2 * unit + 1], 0.0);
    EXPECT_TRUE(std::isfinite(parameters[10 + unit]));
  }
}

TEST(Initialisation, nguyen_widrow_start_has_no_range_above_neurons_without_an_end) {
  const NetworkShape shape{2, {{8, Activation::relu}, {6, Activation::tanh}}};
  EXPECT_EQ(nguyen_widrow_start<double>(shape, {{{3.0, 9.0}, {-1.0, 1.0}}}, 5), xavier_start<double>(shape, 5));
}

}  // namespace
}  // namespace dermis::paper
