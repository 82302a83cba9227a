// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/report/heat_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "report/well_formed.hpp"

namespace dermis::report {
namespace {

/// CIE relative luminance.
double luminance(Colour colour) {
  const auto linear = [](std::uint8_t byte) {
    const double value = byte / 255.0;
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour.red) + 0.7152 * linear(colour.green) + 0.0722 * linear(colour.blue);
}

/// CIE 1976 lightness, 0 ... 100: not the measure that the map is built on.
double lightness(Colour colour) {
  return 116.0 * std::cbrt(luminance(colour)) - 16.0;
}

TEST(SequentialColour, GetsLighterInEvenSteps) {
  double before = lightness(sequential_colour(0.0));
  EXPECT_LT(before, 20.0);
  for (int i = 1; i <= 32; ++i) {
    const double now = lightness(sequential_colour(i / 32.0));
    EXPECT_GT(now - before, 1.2) << i;
    EXPECT_LT(now - before, 3.8) << i;
    before = now;
  }
  EXPECT_GT(before, 88.0);
}

TEST(SequentialColour, ClampsItsArgument) {
  EXPECT_EQ(sequential_colour(-1.0).red, sequential_colour(0.0).red);
  EXPECT_EQ(sequential_colour(2.0).green, sequential_colour(1.0).green);
}

HeatMap map_of(std::size_t rows, std::size_t cols) {
  HeatMap map{"force <N>", rows, cols, 1.0, 1.0, 10.0, std::vector<double>(rows * cols, 0.0)};
  for (std::size_t i = 0; i < map.values.size(); ++i) map.values[i] = static_cast<double>(i % 11);
  return map;
}

TEST(HeatMapTest, IsWellFormedForEverySize) {
  for (const auto& [rows, cols] : {std::pair{1U, 1U}, {16U, 16U}, {32U, 32U}, {1U, 64U}, {64U, 1U}, {200U, 300U}}) {
    const std::string document = svg_document(heat_map(map_of(rows, cols)));
    EXPECT_EQ(xml_error(document), "") << rows << " x " << cols;
    EXPECT_FALSE(has_bad_number(document));
  }
}

TEST(HeatMapTest, CrossesOutWhatIsNotANumber) {
  HeatMap map = map_of(3, 3);
  EXPECT_EQ(heat_map(map).elements.find("class=\"cross\""), std::string::npos);
  map.values[4] = std::numeric_limits<double>::quiet_NaN();
  map.values[5] = std::numeric_limits<double>::infinity();
  map.values[6] = -1.0;
  const std::string elements = heat_map(map).elements;
  EXPECT_NE(elements.find("class=\"cross\""), std::string::npos);
  EXPECT_FALSE(has_bad_number(elements));
}

TEST(HeatMapTest, JoinsEqualNeighboursOfALargeArray) {
  HeatMap map = map_of(256, 256);
  map.values.assign(map.values.size(), 0.0);
  EXPECT_LT(heat_map(map).elements.size(), 30000U);
}

TEST(HeatMapTest, KeepsTheShapeOfTheTaxels) {
  HeatMap map = map_of(4, 4);
  const double square = heat_map(map).height;
  map.row_pitch = 0.6;
  EXPECT_LT(heat_map(map).height, square);
}

TEST(HeatMapHigh, IsTheLargestFiniteValueOrOne) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(heat_map_high({1.0, nan, 7.0, std::numeric_limits<double>::infinity()}), 7.0);
  EXPECT_EQ(heat_map_high({}), 1.0);
  EXPECT_EQ(heat_map_high({nan, -2.0, 0.0}), 1.0);
}

}  // namespace
}  // namespace dermis::report
