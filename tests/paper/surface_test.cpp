// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/report/surface.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "dermis/out/report/heat_map.hpp"
#include "out/report/well_formed.hpp"

namespace dermis::paper {
namespace {

using out::report::Axis;
using out::report::diverging_colour;
using out::report::has_bad_number;
using out::report::occurrences;
using out::report::Scale;
using out::report::svg_document;
using out::report::to_hex;
using out::report::xml_error;

Surface slope(std::size_t rows, std::size_t cols) {
  const Axis floor{"x <cm>", Scale::linear, -3.0, 3.0, {-3.0, 0.0, 3.0}};
  const Axis height{"z", Scale::linear, -1.0, 1.0, {-1.0, 0.0, 1.0}};
  Surface surface{"error & sign", floor, floor, height, rows, cols, {}};
  for (std::size_t i = 0; i < rows * cols; ++i) {
    surface.values.push_back(-1.0 + 2.0 * static_cast<double>(i) / static_cast<double>(rows * cols - 1));
  }
  return surface;
}

TEST(SurfaceTest, draws_a_facet_between_each_four_samples) {
  const std::string document = svg_document(surface(slope(4, 6)));
  EXPECT_EQ(xml_error(document), "");
  EXPECT_EQ(occurrences(document, "class=\"facet\""), 15U);
}

TEST(SurfaceTest, draws_the_farthest_facet_first) {
  Surface step = slope(3, 3);
  step.values = {-1.0, -1.0, 0.0, -1.0, -1.0, 0.0, 0.0, 0.0, 1.0};  // The near corner is low, the far one high.
  const std::string elements = surface(step).elements;
  const std::size_t near = elements.find(to_hex(diverging_colour(-1.0)));
  const std::size_t far = elements.find(to_hex(diverging_colour(0.0)));
  ASSERT_NE(near, std::string::npos);
  ASSERT_NE(far, std::string::npos);
  EXPECT_LT(far, near);
}

TEST(SurfaceTest, leaves_out_facets_without_a_height) {
  Surface holed = slope(4, 4);
  holed.values[5] = std::numeric_limits<double>::quiet_NaN();  // Four facets meet here,
  holed.values[15] = std::numeric_limits<double>::infinity();  // and this is a corner of one.
  const std::string elements = surface(holed).elements;
  EXPECT_EQ(occurrences(elements, "class=\"facet\""), 4U);
  EXPECT_FALSE(has_bad_number(elements));
}

TEST(SurfaceTest, stays_inside_its_picture) {
  Surface steep = slope(2, 2);
  steep.values = {1e30, -1e30, 5.0, -5.0};
  const std::string document = svg_document(surface(steep));
  EXPECT_EQ(xml_error(document), "");
  EXPECT_EQ(document.find("e+"), std::string::npos);
}

}  // namespace
}  // namespace dermis::paper
