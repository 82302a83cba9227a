// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/result.hpp"

/// Where the taxels of an array are in space.
namespace dermis {

/// A point or direction in space [m].
struct Vector3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;

  bool operator==(const Vector3&) const = default;
};

/// A rotation as unit quaternion.
struct Quaternion {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double w = 1.0;

  bool operator==(const Quaternion&) const = default;
};

/// Rotates, then translates: p_base = rotation * p_array + translation.
struct Pose {
  Vector3 translation{};  ///< [m]
  Quaternion rotation{};

  bool operator==(const Pose&) const = default;
};

/// The array lies in the plane z = 0 of its frame, r0c0 at its origin; a press pushes along -z.
struct FlatShape {
  bool operator==(const FlatShape&) const = default;
};

/// Wound round a cylinder; the outside is pressed. Its axis is parallel to x, the direction of the rows, or to y, that
/// of the columns. It is radius_m below the middle of the array (z = -radius_m). Arc lengths are the distances of the
/// flat array.
struct CylinderShape {
  enum class Axis { x, y };
  Axis axis = Axis::y;
  double radius_m = 0.05;  ///< > 0, and large enough for the array to go round at most once.

  bool operator==(const CylinderShape&) const = default;
};

/// Sewn anywhere: the place of each taxel in the array's frame [m], [rows, cols] row-major. Normals come from the
/// neighbours.
struct FreeShape {
  std::vector<Vector3> positions;

  bool operator==(const FreeShape&) const = default;
};

using ArrayShape = std::variant<FlatShape, CylinderShape, FreeShape>;

/// A place on a surface and the direction out of it (unit length), in the suit's frame.
struct SurfacePoint {
  Vector3 position{};
  Vector3 normal{0.0, 0.0, 1.0};
};

/// The surface of one array in the suit's frame. Thread-safe: const after construction.
class ArraySurface {
 public:
  /// `mirrored`: columns run the other way (x -> -x in the array's frame), as on the other side of a body. Fails on a
  /// shape that does not suit the array, as "shape.radius_m: ...", and on a quaternion that is not of unit length.
  [[nodiscard]] static Result<ArraySurface> create(const ArrayDescription& array, const ArrayShape& shape = FlatShape{},
                                                   const Pose& suit_from_array = {}, bool mirrored = false);

  /// The point of each taxel, [rows, cols] row-major.
  [[nodiscard]] std::span<const SurfacePoint> taxels() const noexcept { return taxels_; }

  /// Place of any point of the array's plane (see core/contacts.hpp). Exact on planes and cylinders. A free shape is
  /// interpolated between the taxels and extrapolated beyond the edge. Allocates nothing.
  [[nodiscard]] SurfacePoint at(const PlaneVector& point) const noexcept;

  /// A displacement or velocity along the plane at `point`, in the suit's frame.
  [[nodiscard]] Vector3 along(const PlaneVector& point, const PlaneVector& direction) const noexcept;

 private:
  /// A point in the array's frame, the direction out of the surface there, and how the point moves with x and with y.
  struct Local {
    Vector3 position{};
    Vector3 normal{0.0, 0.0, 1.0};
    Vector3 by_x{1.0, 0.0, 0.0};
    Vector3 by_y{0.0, 1.0, 0.0};
  };

  ArraySurface(const ArrayDescription& array, const ArrayShape& shape, const Pose& suit_from_array, bool mirrored);
  void find_normals(const FreeShape& free);
  [[nodiscard]] Local local(const PlaneVector& point) const noexcept;
  [[nodiscard]] Local on_cylinder(const CylinderShape& cylinder, const PlaneVector& point) const noexcept;
  [[nodiscard]] Local on_free_shape(const FreeShape& free, const PlaneVector& point) const noexcept;
  [[nodiscard]] Vector3 to_suit(const Vector3& direction) const noexcept;

  std::size_t rows_ = 0;
  std::size_t cols_ = 0;
  double row_pitch_m_ = 0.0;
  double col_pitch_m_ = 0.0;
  ArrayShape shape_{};
  Pose suit_from_array_{};
  bool mirrored_ = false;
  std::vector<Vector3> free_normals_;  // of a free shape's taxels in the array's frame
  std::vector<SurfacePoint> taxels_;   // [rows, cols]
};

/// A contact with its place in the suit's frame.
struct SuitContact {
  std::size_t array = 0;  ///< Index of the array.
  Contact contact;
  SurfacePoint place;
  Vector3 velocity{};  ///< [m/s]
};

/// Errors of a shape or a pose by themselves, as "shape.radius_m: ...". ArraySurface::create() checks whether a shape
/// suits its array.
[[nodiscard]] Status validate(const ArrayShape& shape, const Pose& pose);

}  // namespace dermis
