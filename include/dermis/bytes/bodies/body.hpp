// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "dermis/bytes/bodies/surface.hpp"
#include "dermis/touch/frames/result.hpp"

/// The body that wears a suit: links, joints that move them, and what they look like.
namespace dermis {

/// Centred on its origin, as the two below [m].
struct BoxSolid {
  Vector3 size{};
};

/// Along z.
struct CylinderSolid {
  double radius_m = 0.0;
  double length_m = 0.0;
};

struct SphereSolid {
  double radius_m = 0.0;
};

/// Triangles of a file, which only a viewer reads.
struct MeshSolid {
  std::string file;  ///< Its name in the description of the body.
  Vector3 scale{1.0, 1.0, 1.0};
};

/// The visible shape of a link.
struct BodyVisual {
  Pose link_from_visual{};
  std::variant<BoxSolid, CylinderSolid, SphereSolid, MeshSolid> solid{};
  std::optional<std::array<double, 4>> rgba{};  ///< Each 0 ... 1; empty: as the viewer likes.
};

struct BodyLink {
  std::string name;
  std::vector<BodyVisual> visuals{};
};

/// The child turns about the axis or moves along it, as the position of the joint says.
struct BodyJoint {
  enum class Kind { fixed, turning, sliding };
  std::string name;
  Kind kind = Kind::fixed;
  std::size_t parent = 0;  ///< Index of a link; so is `child`.
  std::size_t child = 0;
  Pose parent_from_child{};                                  ///< At position 0.
  Vector3 axis{1.0, 0.0, 0.0};                               ///< In the frame of the child, of unit length.
  double lowest = -std::numeric_limits<double>::infinity();  ///< [rad] or [m]
  double highest = std::numeric_limits<double>::infinity();
};

/// A tree of links. The frame of the first link is that of the suit.
struct Body {
  std::string name;
  std::vector<BodyLink> links;    ///< At least one.
  std::vector<BodyJoint> joints;  ///< One for each link but the first; a parent's before its child's.

  /// Index of a link; empty where there is none of that name.
  [[nodiscard]] std::optional<std::size_t> link(std::string_view name) const;
};

/// Orders links and joints as Body holds them, and makes axes of moving joints of unit length. Errors are no or several
/// first links, a link with two parents, a loop, a repeated name, and an axis or a size of zero. They read "joint
/// 'elbow': ...".
[[nodiscard]] Result<Body> make_body(Body unordered);

/// The pose of each link in the suit's frame. `positions`: of each joint [rad] or [m]; within its limits it moves, and
/// beyond them it stands at the limit.
[[nodiscard]] std::vector<Pose> link_poses(const Body& body, std::span<const double> positions);

/// The same with all joints at 0.
[[nodiscard]] std::vector<Pose> rest_poses(const Body& body);

/// a_from_c of a_from_b and b_from_c.
[[nodiscard]] Pose chained(const Pose& a_from_b, const Pose& b_from_c) noexcept;

/// b_from_a of a_from_b.
[[nodiscard]] Pose inverse(const Pose& a_from_b) noexcept;

/// Where a point is after a move.
[[nodiscard]] Vector3 moved(const Pose& move, const Vector3& point) noexcept;

/// The direction after it.
[[nodiscard]] Vector3 turned(const Pose& move, const Vector3& direction) noexcept;

/// Turns about the fixed axes x, then y, then z [rad], as `rpy` of URDF.
[[nodiscard]] Quaternion rotation_of(double roll, double pitch, double yaw) noexcept;

}  // namespace dermis
