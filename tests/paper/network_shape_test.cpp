// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/network_shape.hpp"

#include <gtest/gtest.h>

#include <string>

namespace dermis::paper {
namespace {

const NetworkShape kShape{3, {{4, Activation::tanh}, {2, Activation::linear}}};

TEST(NetworkShape, places_the_parameters_layer_by_layer_weights_before_thresholds) {
  EXPECT_EQ(kShape.fan_in(0), 3U);
  EXPECT_EQ(kShape.fan_in(1), 4U);
  EXPECT_EQ(kShape.weights(0), 0U);
  EXPECT_EQ(kShape.thresholds(0), 12U);
  EXPECT_EQ(kShape.weights(1), 16U);
  EXPECT_EQ(kShape.thresholds(1), 24U);
  EXPECT_EQ(kShape.parameter_count(), 26U);
  EXPECT_EQ(kShape.outputs(), 2U);
}

TEST(NetworkShape, counts_the_unknowns_of_the_paper) {
  // One N-N-N-1 network a taxel, N = 256: 2 N^3 + N^2 connections, 2 N^2 + N thresholds, 33,751,296 unknowns.
  constexpr std::size_t kTaxels = 256;
  const NetworkShape shape{kTaxels, {{kTaxels}, {kTaxels}, {1}}};
  std::size_t connections = 0;
  for (std::size_t layer = 0; layer < 3; ++layer) connections += shape.thresholds(layer) - shape.weights(layer);
  EXPECT_EQ(kTaxels * connections, 2 * kTaxels * kTaxels * kTaxels + kTaxels * kTaxels);
  EXPECT_EQ(kTaxels * shape.parameter_count(), 33'751'296U);
}

TEST(NetworkShape, is_described_by_its_units) {
  EXPECT_EQ(kShape.describe(), "3-4-2");
}

TEST(NetworkShape, accepts_the_smallest_and_the_largest) {
  EXPECT_TRUE(NetworkShape({1, {{1}}}).validate());
  EXPECT_TRUE(NetworkShape({65'536, {{65'536}, {1}}}).validate());
  EXPECT_TRUE(NetworkShape({1, std::vector<Layer>(kMaxLayers)}).validate());
}

std::string complaint(const NetworkShape& shape) {
  const Status status = shape.validate();
  return status ? "" : status.error().message;
}

TEST(NetworkShape, names_what_is_out_of_range) {
  EXPECT_EQ(complaint({0, {{1}}}), "network.inputs: must be 1 to 65536");
  EXPECT_EQ(complaint({65'537, {{1}}}), "network.inputs: must be 1 to 65536");
  EXPECT_EQ(complaint({1, {}}), "network.layers: must be 1 to 64 layers");
  EXPECT_EQ(complaint({1, std::vector<Layer>(kMaxLayers + 1)}), "network.layers: must be 1 to 64 layers");
  EXPECT_EQ(complaint({1, {{2}, {0}}}), "network.layers[1].units: must be 1 to 65536");
  EXPECT_EQ(complaint({1, {{65'537}}}), "network.layers[0].units: must be 1 to 65536");
  EXPECT_EQ(complaint({1, {{1}, {1, static_cast<Activation>(9)}}}), "network.layers[1].activation: unknown");
}

TEST(NetworkShape, equals_only_the_same_network) {
  NetworkShape other = kShape;
  EXPECT_EQ(other, kShape);
  other.layers[0].activation = Activation::log_sigmoid;
  EXPECT_NE(other, kShape);
}

}  // namespace
}  // namespace dermis::paper
