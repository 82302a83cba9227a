// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/bodies/body.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>
#include <utility>

#include "bytes/bodies/vector3.hpp"

namespace dermis {
namespace {

constexpr double kShortestAxis = 1e-9;

Quaternion product(const Quaternion& a, const Quaternion& b) noexcept {
  return {.x = a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          .y = a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          .z = a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
          .w = a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

Quaternion about(const Vector3& axis, double radians) noexcept {
  const Vector3 half = std::sin(0.5 * radians) * axis;
  return {half.x, half.y, half.z, std::cos(0.5 * radians)};
}

Pose pose_at(const BodyJoint& joint, double position) noexcept {
  const double inside = std::clamp(position, joint.lowest, joint.highest);
  switch (joint.kind) {
    case BodyJoint::Kind::fixed: return joint.parent_from_child;
    case BodyJoint::Kind::turning: return chained(joint.parent_from_child, {{}, about(joint.axis, inside)});
    case BodyJoint::Kind::sliding: return chained(joint.parent_from_child, {inside * joint.axis, {}});
  }
  return joint.parent_from_child;
}

Status check_names(const Body& body) {
  std::set<std::string_view> names;
  for (const BodyLink& link : body.links) {
    if (!names.insert(link.name).second) return bad_input("link '" + link.name + "': is there twice");
  }
  names.clear();
  for (const BodyJoint& joint : body.joints) {
    if (!names.insert(joint.name).second) return bad_input("joint '" + joint.name + "': is there twice");
  }
  return Done{};
}

Status make_axes_unit(std::vector<BodyJoint>& joints) {
  for (BodyJoint& joint : joints) {
    if (joint.kind == BodyJoint::Kind::fixed) continue;
    const double length = std::sqrt(dot(joint.axis, joint.axis));
    if (!(length > kShortestAxis)) return bad_input("joint '" + joint.name + "': its axis has no direction");
    joint.axis = 1.0 / length * joint.axis;
    if (joint.lowest > joint.highest)
      return bad_input("joint '" + joint.name + "': its limits are the wrong way round");
  }
  return Done{};
}

/// The joints that hang from each link, and the one link that hangs from none.
struct Tree {
  std::vector<std::vector<std::size_t>> below;
  std::size_t first = 0;
};

Result<Tree> tree_of(const Body& body) {
  Tree tree{std::vector<std::vector<std::size_t>>(body.links.size()), 0};
  std::vector<bool> has_parent(body.links.size(), false);
  for (std::size_t k = 0; k < body.joints.size(); ++k) {
    const BodyJoint& joint = body.joints[k];
    if (has_parent[joint.child]) {
      return bad_input("link '" + body.links[joint.child].name + "': hangs from two joints");
    }
    has_parent[joint.child] = true;
    tree.below[joint.parent].push_back(k);
  }
  const auto firsts = std::count(has_parent.begin(), has_parent.end(), false);
  if (firsts != 1) {
    return bad_input(firsts == 0 ? "the joints go round: no link is the first"
                                 : "several links hang from no joint; connect them by a fixed joint");
  }
  tree.first = static_cast<std::size_t>(std::find(has_parent.begin(), has_parent.end(), false) - has_parent.begin());
  return tree;
}

}  // namespace

std::optional<std::size_t> Body::link(std::string_view name) const {
  const auto found = std::find_if(links.begin(), links.end(), [&](const BodyLink& link) { return link.name == name; });
  if (found == links.end()) return std::nullopt;
  return static_cast<std::size_t>(found - links.begin());
}

Result<Body> make_body(Body unordered) {
  if (unordered.links.empty()) return bad_input("there is no link");
  if (Status unique = check_names(unordered); !unique) return unique.error();
  if (Status axes = make_axes_unit(unordered.joints); !axes) return axes.error();
  const Result<Tree> tree = tree_of(unordered);
  if (!tree) return tree.error();
  Body body{std::move(unordered.name), {std::move(unordered.links[tree->first])}, {}};
  std::vector<std::size_t> old_links{tree->first};
  for (std::size_t next = 0; next < old_links.size(); ++next) {
    for (const std::size_t k : tree->below[old_links[next]]) {
      BodyJoint joint = std::move(unordered.joints[k]);
      old_links.push_back(joint.child);
      body.links.push_back(std::move(unordered.links[joint.child]));
      joint.parent = next;
      joint.child = body.links.size() - 1;
      body.joints.push_back(std::move(joint));
    }
  }
  if (body.links.size() != unordered.links.size()) return bad_input("the joints of some links go round");
  return body;
}

std::vector<Pose> link_poses(const Body& body, std::span<const double> positions) {
  assert(positions.size() == body.joints.size());
  std::vector<Pose> poses(body.links.size());
  for (std::size_t k = 0; k < body.joints.size(); ++k) {
    const BodyJoint& joint = body.joints[k];
    poses[joint.child] = chained(poses[joint.parent], pose_at(joint, positions[k]));
  }
  return poses;
}

std::vector<Pose> rest_poses(const Body& body) {
  return link_poses(body, std::vector<double>(body.joints.size(), 0.0));
}

Pose chained(const Pose& a_from_b, const Pose& b_from_c) noexcept {
  return {moved(a_from_b, b_from_c.translation), product(a_from_b.rotation, b_from_c.rotation)};
}

Pose inverse(const Pose& a_from_b) noexcept {
  const Quaternion& turn = a_from_b.rotation;
  const Quaternion back{-turn.x, -turn.y, -turn.z, turn.w};
  return {-1.0 * rotated(back, a_from_b.translation), back};
}

Vector3 moved(const Pose& move, const Vector3& point) noexcept {
  return rotated(move.rotation, point) + move.translation;
}

Vector3 turned(const Pose& move, const Vector3& direction) noexcept {
  return rotated(move.rotation, direction);
}

Quaternion rotation_of(double roll, double pitch, double yaw) noexcept {
  const double cr = std::cos(0.5 * roll);
  const double sr = std::sin(0.5 * roll);
  const double cp = std::cos(0.5 * pitch);
  const double sp = std::sin(0.5 * pitch);
  const double cy = std::cos(0.5 * yaw);
  const double sy = std::sin(0.5 * yaw);
  return {.x = sr * cp * cy - cr * sp * sy,
          .y = cr * sp * cy + sr * cp * sy,
          .z = cr * cp * sy - sr * sp * cy,
          .w = cr * cp * cy + sr * sp * sy};
}

}  // namespace dermis
