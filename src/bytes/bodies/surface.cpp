// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/bodies/surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "bytes/bodies/vector3.hpp"

namespace dermis {
namespace {

constexpr double kUnitLengthTolerance = 1e-6;
constexpr double kRoundOff = 1e-9;

bool is_finite(const Vector3& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

Vector3 of_unit_length(const Vector3& a, const Vector3& otherwise) {
  const double length = std::sqrt(dot(a, a));
  return length > kRoundOff ? 1.0 / length * a : otherwise;
}

/// The normal where two directions along a surface determine none, because neighbours are missing or stand in one
/// place. It is as near to z as the surface allows.
Vector3 normal_of(const Vector3& by_x, const Vector3& by_y) {
  const Vector3 outwards = cross(by_x, by_y);
  const double length = std::sqrt(dot(outwards, outwards));
  if (length > kRoundOff * std::sqrt(dot(by_x, by_x) * dot(by_y, by_y))) return 1.0 / length * outwards;
  const Vector3 along = dot(by_x, by_x) >= dot(by_y, by_y) ? by_x : by_y;
  const double square = dot(along, along);
  if (square == 0.0) return {0.0, 0.0, 1.0};
  return of_unit_length(Vector3{0.0, 0.0, 1.0} - along.z / square * along, {1.0, 0.0, 0.0});
}

Status check_size(const ArrayDescription& array, const ArrayShape& shape) {
  if (const auto* const cylinder = std::get_if<CylinderShape>(&shape)) {
    const bool is_wound_along_rows = cylinder->axis == CylinderShape::Axis::y;
    const double length_m = is_wound_along_rows ? static_cast<double>(array.cols) * array.col_pitch_m
                                                : static_cast<double>(array.rows) * array.row_pitch_m;
    const double least_m = length_m / (2.0 * std::numbers::pi);
    if (cylinder->radius_m < least_m * (1.0 - kRoundOff)) {
      return bad_input("shape.radius_m: the array would go round more than once; must be at least " +
                       std::to_string(least_m) + " m");
    }
  }
  if (const auto* const free = std::get_if<FreeShape>(&shape)) {
    if (free->positions.size() != array.taxel_count()) {
      return bad_input("shape.positions: must be " + std::to_string(array.taxel_count()) +
                       " places, one a taxel, has " + std::to_string(free->positions.size()));
    }
  }
  return Done{};
}

/// Between which lines a place lies, and how far from the first to the second; beyond the edge, by the last two.
struct Between {
  std::size_t first = 0;
  std::size_t second = 0;
  double share = 0.0;
};
Between between(double place, std::size_t lines) {
  if (lines < 2) return {0, 0, 0.0};
  const double cell = std::clamp(std::floor(place), 0.0, static_cast<double>(lines - 2));
  const auto first = static_cast<std::size_t>(cell);
  return {first, first + 1, place - cell};
}

}  // namespace

Status validate(const ArrayShape& shape, const Pose& pose) {
  const Quaternion& r = pose.rotation;
  const double square = r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w;
  if (!(std::abs(square - 1.0) <= kUnitLengthTolerance)) {
    return bad_input("base_from_array.rotation: must be a quaternion of length 1");
  }
  if (!is_finite(pose.translation)) return bad_input("base_from_array.translation: must be three numbers");
  if (const auto* const cylinder = std::get_if<CylinderShape>(&shape)) {
    if (!(cylinder->radius_m > 0.0 && std::isfinite(cylinder->radius_m))) {
      return bad_input("shape.radius_m: must be more than 0 m");
    }
  }
  if (const auto* const free = std::get_if<FreeShape>(&shape)) {
    if (!std::all_of(free->positions.begin(), free->positions.end(), is_finite)) {
      return bad_input("shape.positions: must be numbers");
    }
  }
  return Done{};
}

Result<ArraySurface> ArraySurface::create(const ArrayDescription& array, const ArrayShape& shape,
                                          const Pose& suit_from_array, bool mirrored) {
  if (const Status valid = validate(shape, suit_from_array); !valid) return valid.error();
  if (const Status fits = check_size(array, shape); !fits) return fits.error();
  return ArraySurface(array, shape, suit_from_array, mirrored);
}

ArraySurface::ArraySurface(const ArrayDescription& array, const ArrayShape& shape, const Pose& suit_from_array,
                           bool mirrored)
    : rows_(array.rows),
      cols_(array.cols),
      row_pitch_m_(array.row_pitch_m),
      col_pitch_m_(array.col_pitch_m),
      shape_(shape),
      suit_from_array_(suit_from_array),
      mirrored_(mirrored) {
  if (const auto* const free = std::get_if<FreeShape>(&shape_)) find_normals(*free);
  taxels_.reserve(rows_ * cols_);
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) {
      taxels_.push_back(at({static_cast<double>(col) * col_pitch_m_, static_cast<double>(row) * row_pitch_m_}));
    }
  }
}

void ArraySurface::find_normals(const FreeShape& free) {
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) {
      const auto place = [&](std::size_t r, std::size_t c) { return free.positions[r * cols_ + c]; };
      const Vector3 by_x = place(row, std::min(col + 1, cols_ - 1)) - place(row, col - std::min<std::size_t>(col, 1));
      const Vector3 by_y = place(std::min(row + 1, rows_ - 1), col) - place(row - std::min<std::size_t>(row, 1), col);
      free_normals_.push_back(normal_of(by_x, by_y));
    }
  }
}

SurfacePoint ArraySurface::at(const PlaneVector& point) const noexcept {
  const Local here = local(point);
  return {to_suit(here.position) + suit_from_array_.translation, to_suit(here.normal)};
}

Vector3 ArraySurface::along(const PlaneVector& point, const PlaneVector& direction) const noexcept {
  const Local here = local(point);
  return to_suit(direction.x * here.by_x + direction.y * here.by_y);
}

ArraySurface::Local ArraySurface::local(const PlaneVector& point) const noexcept {
  if (const auto* const cylinder = std::get_if<CylinderShape>(&shape_)) return on_cylinder(*cylinder, point);
  if (const auto* const free = std::get_if<FreeShape>(&shape_)) return on_free_shape(*free, point);
  return {.position = {point.x, point.y, 0.0}};
}

ArraySurface::Local ArraySurface::on_cylinder(const CylinderShape& cylinder, const PlaneVector& point) const noexcept {
  const double radius = cylinder.radius_m;
  if (cylinder.axis == CylinderShape::Axis::y) {
    const double middle = 0.5 * static_cast<double>(cols_ - 1) * col_pitch_m_;
    const double angle = (point.x - middle) / radius;
    const double sine = std::sin(angle);
    const double cosine = std::cos(angle);
    return {.position = {middle + radius * sine, point.y, radius * (cosine - 1.0)},
            .normal = {sine, 0.0, cosine},
            .by_x = {cosine, 0.0, -sine}};
  }
  const double middle = 0.5 * static_cast<double>(rows_ - 1) * row_pitch_m_;
  const double angle = (point.y - middle) / radius;
  const double sine = std::sin(angle);
  const double cosine = std::cos(angle);
  return {.position = {point.x, middle + radius * sine, radius * (cosine - 1.0)},
          .normal = {0.0, sine, cosine},
          .by_y = {0.0, cosine, -sine}};
}

ArraySurface::Local ArraySurface::on_free_shape(const FreeShape& free, const PlaneVector& point) const noexcept {
  const Between row = between(point.y / row_pitch_m_, rows_);
  const Between col = between(point.x / col_pitch_m_, cols_);
  const auto place = [&](std::size_t r, std::size_t c) { return free.positions[r * cols_ + c]; };
  const Vector3 first_row = place(row.first, col.second) - place(row.first, col.first);
  const Vector3 second_row = place(row.second, col.second) - place(row.second, col.first);
  const Vector3 first_col = place(row.second, col.first) - place(row.first, col.first);
  const Vector3 second_col = place(row.second, col.second) - place(row.first, col.second);
  Local here;
  here.by_x = 1.0 / col_pitch_m_ * ((1.0 - row.share) * first_row + row.share * second_row);
  here.by_y = 1.0 / row_pitch_m_ * ((1.0 - col.share) * first_col + col.share * second_col);
  here.position = place(row.first, col.first) + col.share * first_row + row.share * first_col +
                  row.share * col.share * (second_row - first_row);
  const auto normal = [&](std::size_t r, std::size_t c) { return free_normals_[r * cols_ + c]; };
  const double down = std::clamp(row.share, 0.0, 1.0);
  const double right = std::clamp(col.share, 0.0, 1.0);
  here.normal = of_unit_length(
      (1.0 - down) * ((1.0 - right) * normal(row.first, col.first) + right * normal(row.first, col.second)) +
          down * ((1.0 - right) * normal(row.second, col.first) + right * normal(row.second, col.second)),
      normal(row.first, col.first));
  return here;
}

Vector3 ArraySurface::to_suit(const Vector3& direction) const noexcept {
  return rotated(suit_from_array_.rotation, {mirrored_ ? -direction.x : direction.x, direction.y, direction.z});
}

}  // namespace dermis
