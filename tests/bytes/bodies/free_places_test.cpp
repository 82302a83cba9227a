// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/bodies/free_places.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dermis {
namespace {

const std::vector<Vector3> kFinger = {{0.0, 0.0, 0.0}, {0.01, 0.0, 0.001}, {0.01, 0.02, 0.0}, {0.0, 0.05, 0.001}};

TEST(FreePlaces, are_discs_that_touch_no_other) {
  const std::vector<FreePlace> places = free_places({1, 4}, FreeShape{kFinger});
  ASSERT_EQ(places.size(), 4U);
  EXPECT_EQ(places[2].x, 0.01);
  EXPECT_EQ(places[2].y, 0.02);
  for (const FreePlace& a : places) {
    EXPECT_GT(a.radius, 0.0);
    for (const FreePlace& b : places) EXPECT_TRUE(&a == &b || std::hypot(a.x - b.x, a.y - b.y) > a.radius + b.radius);
  }
}

TEST(FreePlaces, leave_the_shortest_axis_out) {
  std::vector<Vector3> upright = kFinger;
  for (Vector3& place : upright) std::swap(place.y, place.z);
  const std::vector<FreePlace> places = free_places({4, 1}, FreeShape{upright});
  ASSERT_EQ(places.size(), 4U);
  EXPECT_EQ(places[3].y, 0.05);
}

TEST(FreePlaces, are_none_of_a_grid_or_of_an_even_line) {
  EXPECT_TRUE(free_places({2, 2}, FreeShape{kFinger}).empty());
  EXPECT_TRUE(free_places({1, 4}, FlatShape{}).empty());
  EXPECT_TRUE(free_places({1, 3}, FreeShape{{{0, 0, 0}, {0.01, 0.01, 0}, {0.02, 0.02, 0}}}).empty());
  EXPECT_TRUE(free_places({1, 2}, FreeShape{{{0, 0, 0}, {0.01, 0.01, 0}}}).empty());
}

TEST(FreePlaces, may_be_in_one_place) {
  for (const FreePlace& place : free_places({1, 3}, FreeShape{{{0, 0, 0}, {0.01, 0, 0}, {0, 0, 0}}}))
    EXPECT_TRUE(std::isfinite(place.radius));
}

}  // namespace
}  // namespace dermis
