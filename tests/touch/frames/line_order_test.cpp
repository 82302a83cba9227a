// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/line_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "dermis/touch/frames/random.hpp"

namespace dermis {
namespace {

using Places = std::vector<std::size_t>;

std::string message(const Status& status) {
  return status ? "valid" : status.error().message;
}

/// What is sent:  0 1 2
///                3 4 5
constexpr FrameShape kSent{2, 3};

TEST(LineOrder, changes_nothing_unless_told) {
  const LineOrder order;
  EXPECT_TRUE(order.is_plain());
  EXPECT_EQ(*order.turned(kSent), kSent);
  EXPECT_EQ(order.sent_places(kSent), (Places{0, 1, 2, 3, 4, 5}));
}

TEST(LineOrder, transposes_and_flips_what_is_transposed) {
  LineOrder order;
  order.transpose = true;
  EXPECT_EQ(*order.turned(kSent), (FrameShape{3, 2}));
  EXPECT_EQ(order.sent_places(kSent), (Places{0, 3, 1, 4, 2, 5}));
  order.flip_rows = true;
  EXPECT_EQ(order.sent_places(kSent), (Places{2, 5, 1, 4, 0, 3}));
  order.flip_cols = true;
  EXPECT_EQ(order.sent_places(kSent), (Places{5, 2, 4, 1, 3, 0}));
}

TEST(LineOrder, skips_the_first_columns_before_it_turns) {
  LineOrder order;
  order.skip_columns = 1;
  EXPECT_EQ(*order.turned(kSent), (FrameShape{2, 2}));
  EXPECT_EQ(order.sent_places(kSent), (Places{1, 2, 4, 5}));
  order.flip_cols = true;
  EXPECT_EQ(order.sent_places(kSent), (Places{2, 1, 5, 4}));
  order.skip_columns = 3;
  EXPECT_EQ(order.turned(kSent).error().message, "skip_columns: leaves none of 3 columns");
}

TEST(LineOrder, takes_lines_in_the_order_of_a_list_last) {
  LineOrder order;
  order.col_order = {2, 0, 1};
  EXPECT_EQ(order.sent_places(kSent), (Places{2, 0, 1, 5, 3, 4}));
  order.flip_cols = true;
  EXPECT_EQ(order.sent_places(kSent), (Places{0, 2, 1, 3, 5, 4}));
  order.row_order = {1, 0};
  EXPECT_EQ(order.sent_places(kSent), (Places{3, 5, 4, 0, 2, 1}));
}

TEST(LineOrder, names_a_list_that_is_no_order) {
  LineOrder order;
  order.row_order = {0, 0};
  EXPECT_EQ(message(order.validate()), "row_order: must name each line from 0 to 1 once");
  order.row_order = {0, 2};
  EXPECT_EQ(message(order.validate()), "row_order: must name each line from 0 to 1 once");
  order.row_order = {1, 0};
  order.col_order = {1};
  EXPECT_EQ(message(order.validate()), "col_order: must name each line from 0 to 0 once");
}

TEST(LineOrder, names_a_list_of_another_length_than_the_array) {
  LineOrder order;
  order.row_order = {1, 0};
  EXPECT_EQ(*order.turned(kSent), kSent);
  order.transpose = true;
  EXPECT_EQ(order.turned(kSent).error().message, "row_order: has 2 lines, the array 3");
}

LineOrder random_order(Random& random, FrameShape array) {
  LineOrder order;
  order.skip_columns = random.below(3);
  order.transpose = random.below(2) == 1;
  order.flip_rows = random.below(2) == 1;
  order.flip_cols = random.below(2) == 1;
  for (std::size_t i = 0; i < array.rows; ++i) order.row_order.push_back((i + 1) % array.rows);
  if (random.below(2) == 1) order.row_order.clear();
  for (std::size_t i = 0; i < array.cols; ++i) order.col_order.push_back(array.cols - 1 - i);
  if (random.below(2) == 1) order.col_order.clear();
  return order;
}

TEST(LineOrder, every_taxel_of_any_array_has_a_place_of_its_own) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const FrameShape array{1 + random.below(5), 1 + random.below(5)};
    const LineOrder order = random_order(random, array);
    const FrameShape sent = order.sent(array);
    ASSERT_TRUE(order.turned(sent)) << i;
    EXPECT_EQ(*order.turned(sent), array) << i;
    Places places = order.sent_places(sent);
    std::sort(places.begin(), places.end());
    EXPECT_EQ(std::adjacent_find(places.begin(), places.end()), places.end()) << i;
    EXPECT_EQ(places.size(), array.taxel_count()) << i;
    EXPECT_LT(places.back(), sent.taxel_count()) << i;
    for (const std::size_t place : places) EXPECT_GE(place % sent.cols, order.skip_columns) << i;
  }
}

LineOrder picking(std::vector<std::size_t> taxels, std::size_t rows) {
  return {.taxel_order = std::move(taxels), .taxel_rows = rows, .taxels_sent = kSent};
}

TEST(LineOrder, picks_single_taxels_last) {
  LineOrder order = picking({5, 0, 3, 1}, 2);
  EXPECT_FALSE(order.is_plain());
  EXPECT_EQ(*order.turned(kSent), (FrameShape{2, 2}));
  EXPECT_EQ(order.sent_places(kSent), (Places{5, 0, 3, 1}));
  EXPECT_EQ(order.sent({2, 2}), kSent);
  order.flip_cols = true;
  EXPECT_EQ(order.sent_places(kSent), (Places{3, 2, 5, 1}));
}

TEST(LineOrder, refuses_taxels_that_are_not_there) {
  EXPECT_EQ(message(picking({1, 4, 1}, 1).validate()), "taxel_order: names reading 1 twice");
  EXPECT_EQ(picking({0, 6}, 1).turned(kSent).error().message, "taxel_order: reading 6 is not among 6, counted from 0");
  EXPECT_EQ(picking({0, 1, 2}, 2).turned(kSent).error().message, "taxel_order: 3 taxels do not fill 2 rows");
  EXPECT_EQ(picking({0, 1}, 1).turned({3, 2}).error().message, "taxel_order: is for frames of 2x3, not of 3x2");
}

}  // namespace
}  // namespace dermis
