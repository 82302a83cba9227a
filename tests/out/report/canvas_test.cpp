// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/canvas.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "dermis/out/report/svg.hpp"
#include "out/report/well_formed.hpp"

namespace dermis::out::report {
namespace {

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

TEST(Canvas, writes_elements_that_a_drawing_can_hold) {
  Canvas canvas;
  canvas.open_group("s1");
  canvas.line("grid", {0.0, 1.0}, {2.5, 3.125});
  canvas.rectangle("frame", {1.0, 2.0}, 30.0, 40.0);
  canvas.path("curve", move_to({0.0, 0.0}) + line_to({1.0, 1.0}));
  canvas.filled_path("facet", "#ff0000", move_to({0.0, 0.0}) + line_to({1.0, 1.0}) + "Z");
  canvas.text("small", Anchor::end, {5.0, 6.0}, "a & b");
  canvas.upright_text("muted", {7.0, 8.0}, "height <m>");
  canvas.close_group();
  const std::string elements = std::move(canvas).take();
  EXPECT_TRUE(contains(elements, "x2=\"2.5\""));
  EXPECT_TRUE(contains(elements, "class=\"small end\""));
  EXPECT_TRUE(contains(elements, ">a &amp; b</text>"));
  EXPECT_TRUE(contains(elements, "rotate(-90)\">height &lt;m&gt;</text>"));
  EXPECT_EQ(xml_error(svg_document({50.0, 50.0, "all elements", elements})), "");
}

TEST(Canvas, leaves_out_a_path_without_points) {
  Canvas canvas;
  canvas.path("curve", "");
  EXPECT_EQ(std::move(canvas).take(), "");
}

TEST(Canvas, rounds_lengths_to_hundredths_of_a_pixel) {
  EXPECT_EQ(coordinate(1.0 / 3.0), "0.33");
  EXPECT_EQ(coordinate(12.0), "12");
}

TEST(Canvas, series_differ_in_class_and_mark) {
  EXPECT_NE(series_class(0), series_class(1));
  EXPECT_NE(mark(0, {0.0, 0.0}), mark(1, {0.0, 0.0}));
}

TEST(Canvas, longer_words_are_wider) {
  EXPECT_GT(text_width("relative error"), text_width("error"));
}

}  // namespace
}  // namespace dermis::out::report
