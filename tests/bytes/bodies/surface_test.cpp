// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/bodies/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"

namespace dermis {
namespace {

constexpr double kRoundOff = 1e-12;

ArrayDescription array_of(std::size_t rows, std::size_t cols) {
  ArrayDescription array;
  array.rows = rows;
  array.cols = cols;
  array.row_pitch_m = 0.008;
  array.col_pitch_m = 0.010;
  return array;
}

ArraySurface surface_of(const ArrayDescription& array, const ArrayShape& shape = FlatShape{}, const Pose& pose = {},
                        bool mirrored = false) {
  return ArraySurface::create(array, shape, pose, mirrored).value();
}

std::string message_of(const ArrayDescription& array, const ArrayShape& shape, const Pose& pose = {}) {
  const Result<ArraySurface> surface = ArraySurface::create(array, shape, pose);
  return surface ? "valid" : surface.error().message;
}

void expect_near(const Vector3& a, const Vector3& b, double tolerance = kRoundOff) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

double dot(const Vector3& a, const Vector3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Turned by 90 degrees about z, then moved.
Pose quarter_turn() {
  return {{1.0, 2.0, 3.0}, {0.0, 0.0, std::numbers::sqrt2 / 2.0, std::numbers::sqrt2 / 2.0}};
}

/// The places of the taxels as a surface itself tells them.
FreeShape places_of(const ArraySurface& surface) {
  FreeShape free;
  for (const SurfacePoint& taxel : surface.taxels()) free.positions.push_back(taxel.position);
  return free;
}

TEST(ArraySurface, taxels_of_a_flat_array_stand_at_their_pitch_and_look_along_z) {
  const ArraySurface surface = surface_of(array_of(3, 4));
  ASSERT_EQ(surface.taxels().size(), 12U);
  expect_near(surface.taxels()[11].position, {0.030, 0.016, 0.0});
  for (const SurfacePoint& taxel : surface.taxels()) expect_near(taxel.normal, {0.0, 0.0, 1.0});
}

TEST(ArraySurface, a_pose_turns_and_then_moves) {
  const ArraySurface surface = surface_of(array_of(3, 4), FlatShape{}, quarter_turn());
  expect_near(surface.at({0.010, 0.0}).position, {1.0, 2.010, 3.0});
  expect_near(surface.at({0.0, 0.016}).position, {1.0 - 0.016, 2.0, 3.0});
  expect_near(surface.along({0.0, 0.0}, {1.0, 2.0}), {-2.0, 1.0, 0.0});
}

TEST(ArraySurface, columns_of_a_mirrored_array_run_the_other_way) {
  const ArraySurface surface = surface_of(array_of(3, 4), FlatShape{}, {}, true);
  expect_near(surface.at({0.030, 0.016}).position, {-0.030, 0.016, 0.0});
  expect_near(surface.at({0.030, 0.016}).normal, {0.0, 0.0, 1.0});
  expect_near(surface.along({0.0, 0.0}, {1.0, 2.0}), {-1.0, 2.0, 0.0});
}

TEST(ArraySurface, a_cylinder_along_the_columns_direction_bends_the_rows) {
  const double radius = 0.05;
  const ArraySurface surface = surface_of(array_of(5, 16), CylinderShape{CylinderShape::Axis::y, radius});
  const double middle = 0.5 * 15.0 * 0.010;
  for (std::size_t col = 0; col < 16; ++col) {
    SCOPED_TRACE(col);
    const double angle = (0.010 * static_cast<double>(col) - middle) / radius;
    const SurfacePoint& taxel = surface.taxels()[32 + col];
    expect_near(taxel.position, {middle + radius * std::sin(angle), 0.016, radius * std::cos(angle) - radius});
    expect_near(taxel.normal, {std::sin(angle), 0.0, std::cos(angle)});
  }
}

TEST(ArraySurface, a_cylinder_along_the_rows_direction_bends_the_columns) {
  const double radius = 0.03;
  const ArraySurface surface = surface_of(array_of(9, 3), CylinderShape{CylinderShape::Axis::x, radius});
  const PlaneVector point{0.013, 0.057};  // between taxels
  const double angle = (point.y - 0.032) / radius;
  expect_near(surface.at(point).position, {0.013, 0.032 + radius * std::sin(angle), radius * std::cos(angle) - radius});
  expect_near(surface.along(point, {0.5, 2.0}), {0.5, 2.0 * std::cos(angle), -2.0 * std::sin(angle)});
}

TEST(ArraySurface, a_mirrored_cylinder_in_a_pose_is_pressed_from_outside) {
  const double radius = 0.05;
  const ArraySurface surface =
      surface_of(array_of(4, 16), CylinderShape{CylinderShape::Axis::y, radius}, quarter_turn(), true);
  // The axis: mirrored to x = -middle, z = -radius, then turned to y = 2 - middle.
  const Vector3 on_axis{1.0, 2.0 - 0.075, 3.0 - radius};
  for (const SurfacePoint& taxel : surface.taxels()) {
    const Vector3 outwards{0.0, taxel.position.y - on_axis.y, taxel.position.z - on_axis.z};
    EXPECT_NEAR(dot(outwards, taxel.normal), radius, kRoundOff);
    EXPECT_NEAR(dot(taxel.normal, taxel.normal), 1.0, kRoundOff);
  }
}

TEST(ArraySurface, velocities_are_how_places_change) {
  const ArrayDescription array = array_of(6, 7);
  const ArraySurface bent = surface_of(array, CylinderShape{CylinderShape::Axis::x, 0.04}, quarter_turn(), true);
  const ArraySurface free = surface_of(array, places_of(bent), quarter_turn(), true);
  const PlaneVector point{0.0234, 0.0187};
  const PlaneVector velocity{0.3, -0.2};
  constexpr double kStep = 1e-6;
  for (const ArraySurface* const surface : {&bent, &free}) {
    const Vector3 before = surface->at(point).position;
    const Vector3 after = surface->at({point.x + kStep * velocity.x, point.y + kStep * velocity.y}).position;
    expect_near(surface->along(point, velocity),
                {(after.x - before.x) / kStep, (after.y - before.y) / kStep, (after.z - before.z) / kStep}, 1e-4);
  }
}

TEST(ArraySurface, a_free_shape_with_the_places_of_a_plane_is_that_plane) {
  const ArrayDescription array = array_of(4, 5);
  const ArraySurface flat = surface_of(array);
  const ArraySurface free = surface_of(array, places_of(flat));
  Random random(1);
  for (int k = 0; k < 100; ++k) {  // within and beyond the edge
    const PlaneVector point{random.uniform(-0.02, 0.06), random.uniform(-0.02, 0.05)};
    expect_near(free.at(point).position, flat.at(point).position);
    expect_near(free.at(point).normal, {0.0, 0.0, 1.0});
    expect_near(free.along(point, {0.1, 0.2}), {0.1, 0.2, 0.0});
  }
}

TEST(ArraySurface, a_free_shape_with_the_places_of_a_cylinder_is_near_it) {
  const ArrayDescription array = array_of(12, 16);
  const ArraySurface bent = surface_of(array, CylinderShape{CylinderShape::Axis::y, 0.06});
  const ArraySurface free = surface_of(array, places_of(bent));
  Random random(2);
  for (int k = 0; k < 100; ++k) {
    const PlaneVector point{random.uniform(0.010, 0.140), random.uniform(0.0, 0.088)};
    expect_near(free.at(point).position, bent.at(point).position, 0.0003);
    EXPECT_GT(dot(free.at(point).normal, bent.at(point).normal), std::cos(0.02));
  }
}

TEST(ArraySurface, a_free_shape_passes_through_its_places) {
  const ArrayDescription array = array_of(3, 3);
  FreeShape shape;
  Random random(3);
  for (int k = 0; k < 9; ++k) {
    shape.positions.push_back({random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)});
  }
  const ArraySurface surface = surface_of(array, shape);
  for (std::size_t k = 0; k < 9; ++k) {
    expect_near(surface.taxels()[k].position, shape.positions[k]);
    EXPECT_NEAR(dot(surface.taxels()[k].normal, surface.taxels()[k].normal), 1.0, kRoundOff);
  }
}

TEST(ArraySurface, normals_exist_without_neighbours_and_where_taxels_share_a_place) {
  const ArraySurface single = surface_of(array_of(1, 1), FreeShape{{{0.1, 0.2, 0.3}}});
  expect_near(single.taxels()[0].normal, {0.0, 0.0, 1.0});
  const ArraySurface strip = surface_of(array_of(1, 2), FreeShape{{{0.0, 0.0, 0.0}, {0.01, 0.0, 0.01}}});
  expect_near(strip.at({0.005, 0.0}).normal, {-std::numbers::sqrt2 / 2.0, 0.0, std::numbers::sqrt2 / 2.0});
  const ArraySurface upright = surface_of(array_of(1, 2), FreeShape{{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.01}}});
  EXPECT_NEAR(dot(upright.taxels()[0].normal, upright.taxels()[0].normal), 1.0, kRoundOff);
  EXPECT_NEAR(upright.taxels()[0].normal.z, 0.0, kRoundOff);
  const ArraySurface heap = surface_of(array_of(2, 2), FreeShape{{{}, {}, {}, {}}});
  expect_near(heap.taxels()[3].normal, {0.0, 0.0, 1.0});
}

TEST(ArraySurface, refuses_what_does_not_suit) {
  const ArrayDescription array = array_of(2, 16);
  EXPECT_EQ(message_of(array, CylinderShape{CylinderShape::Axis::y, 0.0254}),
            "shape.radius_m: the array would go round more than once; must be at least 0.025465 m");
  EXPECT_EQ(message_of(array, CylinderShape{CylinderShape::Axis::y, 0.16 / (2.0 * std::numbers::pi)}), "valid");
  EXPECT_EQ(message_of(array, CylinderShape{CylinderShape::Axis::x, 0.0254}), "valid");
  EXPECT_EQ(message_of(array, CylinderShape{CylinderShape::Axis::y, 0.0}), "shape.radius_m: must be more than 0 m");
  EXPECT_EQ(message_of(array, CylinderShape{CylinderShape::Axis::y, NAN}), "shape.radius_m: must be more than 0 m");
  EXPECT_EQ(message_of(array, FreeShape{{{}, {}}}), "shape.positions: must be 32 places, one a taxel, has 2");
  EXPECT_EQ(message_of(array_of(1, 1), FreeShape{{{NAN, 0.0, 0.0}}}), "shape.positions: must be numbers");
  EXPECT_EQ(message_of(array, FlatShape{}, {{}, {0.0, 0.0, 0.0, 1.1}}),
            "base_from_array.rotation: must be a quaternion of length 1");
  EXPECT_EQ(message_of(array, FlatShape{}, {{}, {NAN, 0.0, 0.0, 1.0}}),
            "base_from_array.rotation: must be a quaternion of length 1");
  EXPECT_EQ(message_of(array, FlatShape{}, {{0.0, INFINITY, 0.0}, {}}),
            "base_from_array.translation: must be three numbers");
}

TEST(ArraySurface, tells_places_without_allocating) {
  const ArrayDescription array = array_of(6, 7);
  const ArraySurface bent = surface_of(array, CylinderShape{CylinderShape::Axis::y, 0.04});
  const ArraySurface free = surface_of(array, places_of(bent));
  double sum = 0.0;
  const support::AllocationGuard guard;
  for (const ArraySurface* const surface : {&bent, &free}) {
    sum += surface->at({0.01, 0.02}).position.z + surface->along({0.01, 0.02}, {1.0, 1.0}).z;
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
}  // namespace dermis
