// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/bodies/wrench.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "dermis/bytes/bodies/surface.hpp"

namespace dermis {
namespace {

SuitContact contact(double force_n, const Vector3& position, const Vector3& normal = {0.0, 0.0, 1.0}) {
  SuitContact placed;
  placed.contact.force_n = force_n;
  placed.place = {position, normal};
  return placed;
}

void expect_near(const Vector3& found, const Vector3& expected) {
  EXPECT_NEAR(found.x, expected.x, 1e-12);
  EXPECT_NEAR(found.y, expected.y, 1e-12);
  EXPECT_NEAR(found.z, expected.z, 1e-12);
}

TEST(Wrench, nothing_presses_with_nothing) {
  EXPECT_EQ(wrench_of({}), Wrench{});
}

TEST(Wrench, a_press_pushes_against_the_normal_and_turns_about_the_origin) {
  const Wrench wrench = wrench_of(std::vector{contact(2.0, {0.1, 0.2, 0.0})});
  expect_near(wrench.force, {0.0, 0.0, -2.0});
  expect_near(wrench.torque, {-0.4, 0.2, 0.0});
}

TEST(Wrench, presses_from_both_sides_cancel_out) {
  const Wrench wrench =
      wrench_of(std::vector{contact(3.0, {0.1, 0.0, 0.2}), contact(3.0, {0.1, 0.0, -0.2}, {0.0, 0.0, -1.0})});
  expect_near(wrench.force, {});
  expect_near(wrench.torque, {});
}

TEST(Wrench, the_frame_of_an_array_sees_its_contacts_as_the_array_lies) {
  const double half = std::numbers::sqrt2 / 2.0;
  const Pose suit_from_array{{1.0, 2.0, 3.0}, {0.0, half, 0.0, half}};  // its z is the suit's x
  ArrayDescription array;
  array.rows = 2;
  array.cols = 3;
  const ArraySurface flat = ArraySurface::create(array).value();
  const ArraySurface placed = ArraySurface::create(array, FlatShape{}, suit_from_array).value();
  const PlaneVector place{0.015, 0.005};
  const auto press = [&](const ArraySurface& surface) {
    return std::vector{contact(5.0, surface.at(place).position, surface.at(place).normal)};
  };
  expect_near(wrench_of(press(placed)).force, {-5.0, 0.0, 0.0});
  const Wrench in_array = wrench_of(press(placed), suit_from_array);
  const Wrench expected = wrench_of(press(flat));
  expect_near(in_array.force, expected.force);
  expect_near(in_array.torque, expected.torque);
}

}  // namespace
}  // namespace dermis
