// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "out/report/well_formed.hpp"

namespace dermis::out::report {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Values = std::vector<double>;

TEST(LinearTicks, are_exact_multiples_of_one_two_or_five) {
  EXPECT_EQ(linear_ticks(0.0, 50.0, 6), (Values{0, 10, 20, 30, 40, 50}));
  EXPECT_EQ(linear_ticks(0.0, 1.0, 6), (Values{0.0, 0.2, 0.4, 0.6, 0.8, 1.0}));
  EXPECT_EQ(linear_ticks(-0.3, 0.3, 8), (Values{-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3}));
  EXPECT_EQ(linear_ticks(4.51, 5.49, 6), (Values{4.6, 4.8, 5.0, 5.2, 5.4}));
  EXPECT_EQ(linear_ticks(0.0, 3e6, 4), (Values{0, 1e6, 2e6, 3e6}));
}

TEST(LinearTicks, have_no_negative_zero) {
  for (const double tick : linear_ticks(0.0, 7.0, 5)) EXPECT_FALSE(std::signbit(tick));
}

TEST(LogTicks, are_one_two_five_or_thinned_out_decades) {
  EXPECT_EQ(log_ticks(1.0, 50.0), (Values{1, 2, 5, 10, 20, 50}));
  EXPECT_EQ(log_ticks(0.15, 3.0), (Values{0.2, 0.5, 1, 2}));
  EXPECT_EQ(log_ticks(0.001, 100.0), (Values{0.001, 0.01, 0.1, 1, 10, 100}));
  EXPECT_EQ(log_ticks(0.02, 3000.0), (Values{0.1, 1, 10, 100, 1000}));
  const Values wide = log_ticks(1e-20, 1e20);
  EXPECT_LE(wide.size(), 12U);
  EXPECT_GE(wide.size(), 6U);
  for (std::size_t i = 2; i < wide.size(); ++i) EXPECT_NEAR(wide[i] / wide[i - 1], wide[1] / wide[0], 1e-3);
}

TEST(NiceAxis, goes_from_tick_to_tick_around_the_values) {
  const Axis linear = nice_axis("x", Scale::linear, Values{0.3, 47.0, kNan, kInfinity});
  EXPECT_EQ(linear.low, 0.0);
  EXPECT_EQ(linear.high, 50.0);
  const Axis logarithmic = nice_axis("x", Scale::logarithmic, Values{0.0, -3.0, 1.0, 50.0001, kInfinity});
  EXPECT_EQ(logarithmic.low, 1.0);
  EXPECT_EQ(logarithmic.high, 50.0);
}

TEST(NiceAxis, takes_any_values) {
  const std::vector<Values> hard = {
      {},       {kNan}, {0.0},         {20.0},        {20.0, 20.0 + 1e-13}, {-1e300, 1e300},
      {1e-300}, {-5.0}, {1e-99, 1e99}, {-1e99, 1e99}, {0.0, 1e-320}};
  for (const Values& values : hard) {
    for (const Scale scale : {Scale::linear, Scale::logarithmic}) {
      const Axis axis = nice_axis("x", scale, values);
      EXPECT_LT(axis.low, axis.high);
      EXPECT_TRUE(std::isfinite(axis.low) && std::isfinite(axis.high));
      EXPECT_GE(axis.ticks.size(), 2U);
      EXPECT_LE(axis.ticks.size(), 13U);
      EXPECT_TRUE(scale == Scale::linear || axis.low > 0.0);
    }
  }
}

TEST(Axis, places_values) {
  const Axis linear{"x", Scale::linear, 10.0, 20.0, {}};
  EXPECT_DOUBLE_EQ(linear.position(12.5), 0.25);
  EXPECT_EQ(linear.position(-kInfinity), 0.0);
  EXPECT_EQ(linear.position(kInfinity), 1.0);
  EXPECT_TRUE(std::isnan(linear.position(kNan)));
  const Axis logarithmic{"x", Scale::logarithmic, 0.1, 1000.0, {}};
  EXPECT_DOUBLE_EQ(logarithmic.position(10.0), 0.5);
  EXPECT_EQ(logarithmic.position(0.0), 0.0);
  EXPECT_EQ(logarithmic.position(-1.0), 0.0);
}

Plot hard_plot() {
  const Axis axis = nice_axis("force [N] <&>", Scale::logarithmic, Values{1.0, 50.0});
  Plot plot("title \"<&>\"", axis, axis, 480.0, 350.0);
  const std::vector<Point> points = {{1, 2}, {kNan, 3}, {5, kNan}, {10, kInfinity}, {20, -kInfinity}, {0, 0}, {50, 7}};
  plot.region("band", {{1, 1}, {50, 50}, {50, 40}});
  plot.reference("truth", points);
  plot.curve("<b>", 0, points);
  plot.cloud("dots", 1, points);
  plot.whiskers(2, points, points);
  plot.line("line", 3, points, 4);
  plot.label({5.0, kInfinity}, "<label>");
  plot.label({kNan, 5.0}, "nowhere");
  plot.count(1.0, 12);
  plot.count(kNan, 12);
  return plot;
}

TEST(Plot, draws_only_finite_numbers_and_escapes_text) {
  const std::string document = svg_document(hard_plot().drawing());
  EXPECT_EQ(xml_error(document), "");
  EXPECT_FALSE(has_bad_number(document));
  EXPECT_NE(document.find("&lt;b&gt;"), std::string::npos);
}

TEST(Plot, breaks_lines_where_a_point_is_missing) {
  const Axis axis{"x", Scale::linear, 0.0, 10.0, {}};
  Plot plot("t", axis, axis, 300.0, 300.0);
  plot.reference("", {{0, 0}, {1, 1}, {kNan, 2}, {3, 3}, {4, 4}});
  const std::string elements = plot.drawing().elements;
  const std::size_t start = elements.find("class=\"reference\"");
  const std::string path = elements.substr(start, elements.find("/>", start) - start);
  EXPECT_EQ(occurrences(path, "M"), 2U);
  EXPECT_EQ(occurrences(path, "L"), 2U);
}

TEST(Plot, labels_places) {
  const std::string elements = hard_plot().drawing().elements;
  EXPECT_NE(elements.find("&lt;label&gt;"), std::string::npos);
  EXPECT_EQ(elements.find("nowhere"), std::string::npos);
}

TEST(Plot, marks_a_few_points_of_a_line) {
  std::vector<Point> points;
  for (int i = 0; i <= 1000; ++i) points.push_back({0.01 * i, 5.0});
  const Axis axis{"x", Scale::linear, 0.0, 10.0, {}};
  const auto marks = [&](std::size_t most) {
    Plot plot("t", axis, axis, 300.0, 300.0);
    plot.line("", 0, points, most);
    return occurrences(plot.drawing().elements, "a3.6");
  };
  EXPECT_EQ(marks(0), 0U);
  const std::size_t circles = marks(8) / 2;  // A circle is two arcs.
  EXPECT_GE(circles, 7U);
  EXPECT_LE(circles, 9U);
}

TEST(Plot, puts_earlier_series_above) {
  const Axis axis{"x", Scale::linear, 0.0, 10.0, {}};
  Plot plot("t", axis, axis, 300.0, 300.0);
  plot.curve("", 0, {{1, 1}});
  plot.curve("", 1, {{1, 1}});
  const std::string elements = plot.drawing().elements;
  EXPECT_GT(elements.find("class=\"s0\""), elements.find("class=\"s1\""));
}

TEST(Plot, gives_many_series_a_look) {
  const Axis axis{"x", Scale::linear, 0.0, 10.0, {}};
  Plot plot("t", axis, axis, 300.0, 500.0);
  for (std::size_t i = 0; i < 20; ++i) plot.curve("series " + std::to_string(i), i, {{1, 1}, {2, 2}});
  EXPECT_EQ(xml_error(svg_document(plot.drawing())), "");
}

}  // namespace
}  // namespace dermis::out::report
