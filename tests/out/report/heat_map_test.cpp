// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/heat_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "out/report/well_formed.hpp"

namespace dermis::out::report {
namespace {

/// A component of sRGB without its gamma.
double linear_part(std::uint8_t byte) {
  const double value = byte / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

/// CIE relative luminance.
double luminance(Colour colour) {
  return 0.2126 * linear_part(colour.red) + 0.7152 * linear_part(colour.green) + 0.0722 * linear_part(colour.blue);
}

/// CIE 1976 lightness, 0 ... 100: not the measure that the map is built on.
double lightness(Colour colour) {
  return 116.0 * std::cbrt(luminance(colour)) - 16.0;
}

using Linear = std::array<double, 3>;

/// How a kind of colour vision sees linear sRGB; G. M. Machado, M. M. Oliveira and L. A. F. Fernandes, "A
/// physiologically-based model for simulation of color vision deficiency", 2009, table for severity 1.0.
struct Vision {
  const char* name;
  std::array<double, 9> matrix;
};

constexpr std::array<Vision, 4> kVisions = {
    {{"normal", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
     {"protanopia", {0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998}},
     {"deuteranopia", {0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881}},
     {"tritanopia", {1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900}}}};

Linear seen(const Vision& vision, Colour colour) {
  const Linear linear = {linear_part(colour.red), linear_part(colour.green), linear_part(colour.blue)};
  Linear result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i] += vision.matrix[3 * i + j] * linear[j];
    result[i] = std::max(result[i], 0.0);
  }
  return result;
}

Linear oklab(const Linear& c) {
  const double l = std::cbrt(0.4122214708 * c[0] + 0.5363325363 * c[1] + 0.0514459929 * c[2]);
  const double m = std::cbrt(0.2119034982 * c[0] + 0.6806995451 * c[1] + 0.1073969566 * c[2]);
  const double s = std::cbrt(0.0883024619 * c[0] + 0.2817188376 * c[1] + 0.6299787005 * c[2]);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

double oklab_distance(const Linear& one, const Linear& other) {
  const Linear a = oklab(one);
  const Linear b = oklab(other);
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(SequentialColour, gets_lighter_in_even_steps) {
  EXPECT_LT(lightness(sequential_colour(0.0)), 20.0);
  double before = lightness(sequential_colour(0.01));
  for (int i = 1; i <= 32; ++i) {
    const double now = lightness(sequential_colour(0.01 + 0.99 * i / 32.0));
    EXPECT_GT(now - before, 1.2) << i;
    EXPECT_LT(now - before, 3.8) << i;
    before = now;
  }
  EXPECT_GT(before, 88.0);
}

TEST(SequentialColour, tells_the_first_percent_from_nothing_to_any_colour_vision) {
  constexpr double kJustSeen = 0.02;
  for (const auto& vision : kVisions) {
    const double distance = oklab_distance(seen(vision, sequential_colour(0.0)), seen(vision, sequential_colour(0.01)));
    EXPECT_GT(distance, 3.0 * kJustSeen) << vision.name;
  }
}

TEST(SequentialColour, clamps_its_argument) {
  EXPECT_EQ(sequential_colour(-1.0).red, sequential_colour(0.0).red);
  EXPECT_EQ(sequential_colour(2.0).green, sequential_colour(1.0).green);
}

TEST(DivergingColour, darkens_evenly_and_alike_on_both_sides) {
  EXPECT_GT(lightness(diverging_colour(0.0)), 93.0);
  for (int i = 1; i <= 16; ++i) {
    const double negative = lightness(diverging_colour(-i / 16.0));
    const double positive = lightness(diverging_colour(i / 16.0));
    EXPECT_NEAR(negative, positive, 2.5) << i;
    EXPECT_LT(negative, lightness(diverging_colour((1 - i) / 16.0)) - 2.0) << i;
    EXPECT_LT(positive, lightness(diverging_colour((i - 1) / 16.0)) - 2.0) << i;
  }
}

TEST(DivergingColour, tells_the_sign_to_any_colour_vision) {
  for (const auto& vision : kVisions) {
    for (int i = 4; i <= 16; ++i) {
      const double distance =
          oklab_distance(seen(vision, diverging_colour(-i / 16.0)), seen(vision, diverging_colour(i / 16.0)));
      EXPECT_GT(distance, 0.07) << vision.name << " " << i;
    }
  }
}

TEST(DivergingColour, stays_inside_the_gamut) {
  // Clipped components would bend the lightness; only the ends of a component's range could have been clipped.
  for (int i = -64; i <= 64; ++i) {
    const Colour colour = diverging_colour(i / 64.0);
    for (const std::uint8_t part : {colour.red, colour.green, colour.blue}) {
      EXPECT_GT(part, 0) << i;
      EXPECT_LT(part, 255) << i;
    }
  }
}

TEST(DivergingColour, clamps_its_argument) {
  EXPECT_EQ(to_hex(diverging_colour(-7.0)), to_hex(diverging_colour(-1.0)));
  EXPECT_EQ(to_hex(diverging_colour(7.0)), to_hex(diverging_colour(1.0)));
}

HeatMap map_of(std::size_t rows, std::size_t cols) {
  HeatMap map{"force <N>", rows, cols, 1.0, 1.0, 10.0, std::vector<double>(rows * cols, 0.0)};
  for (std::size_t i = 0; i < map.values.size(); ++i) map.values[i] = static_cast<double>(i % 11);
  return map;
}

TEST(HeatMapTest, is_well_formed_for_every_size) {
  for (const auto& [rows, cols] : {std::pair{1U, 1U}, {16U, 16U}, {32U, 32U}, {1U, 64U}, {64U, 1U}, {200U, 300U}}) {
    const std::string document = svg_document(heat_map(map_of(rows, cols)));
    EXPECT_EQ(xml_error(document), "") << rows << " x " << cols;
    EXPECT_FALSE(has_bad_number(document));
  }
}

TEST(HeatMapTest, crosses_out_what_is_not_a_number) {
  HeatMap map = map_of(3, 3);
  EXPECT_EQ(heat_map(map).elements.find("class=\"cross\""), std::string::npos);
  map.values[4] = std::numeric_limits<double>::quiet_NaN();
  map.values[5] = std::numeric_limits<double>::infinity();
  map.values[6] = -1.0;
  const std::string elements = heat_map(map).elements;
  EXPECT_NE(elements.find("class=\"cross\""), std::string::npos);
  EXPECT_FALSE(has_bad_number(elements));
}

TEST(HeatMapTest, joins_equal_neighbours_of_a_large_array) {
  HeatMap map = map_of(256, 256);
  map.values.assign(map.values.size(), 0.0);
  EXPECT_LT(heat_map(map).elements.size(), 30000U);
}

TEST(HeatMapTest, keeps_the_shape_of_the_taxels) {
  HeatMap map = map_of(4, 4);
  const double square = heat_map(map).height;
  map.row_pitch = 0.6;
  EXPECT_LT(heat_map(map).height, square);
}

TEST(HeatMapTest, shows_signed_values_around_the_middle_of_its_scale) {
  HeatMap map = map_of(1, 3);
  map.colours = Colours::diverging;
  map.values = {-10.0, 0.0, 10.0};
  const std::string elements = heat_map(map).elements;
  for (const double share : {-1.0, 1.0}) {
    EXPECT_GE(occurrences(elements, to_hex(diverging_colour(share))), 2U) << "a cell and the scale, " << share;
  }
  EXPECT_NE(elements.find(">-10</text>"), std::string::npos);
  EXPECT_NE(elements.find(">10</text>"), std::string::npos);
}

TEST(HeatMapTest, puts_the_first_row_of_a_function_at_the_bottom) {
  HeatMap map = map_of(2, 1);
  map.values = {0.0, 10.0};
  const auto top_of_high = [&] {
    const std::string elements = heat_map(map).elements;
    const std::string opening = "fill=\"" + to_hex(sequential_colour(1.0)) + "\" d=\"M";
    const std::size_t at = elements.find(opening);
    return std::stod(elements.substr(elements.find(' ', at + opening.size())));
  };
  const double as_taxels = top_of_high();
  const Axis axis{"x", Scale::linear, -3.0, 3.0, {-3.0, 0.0, 3.0}};
  map.axes = MapAxes{axis, axis};
  EXPECT_GT(as_taxels, 100.0);
  EXPECT_LT(top_of_high(), 50.0);
  EXPECT_EQ(heat_map(map).elements.find(">r0</text>"), std::string::npos);
  EXPECT_EQ(xml_error(svg_document(heat_map(map))), "");
}

TEST(HeatMapHigh, is_the_largest_finite_value_or_one) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(heat_map_high({1.0, nan, 7.0, std::numeric_limits<double>::infinity()}), 7.0);
  EXPECT_EQ(heat_map_high({}), 1.0);
  EXPECT_EQ(heat_map_high({nan, -2.0, 0.0}), 1.0);
}

}  // namespace
}  // namespace dermis::out::report
