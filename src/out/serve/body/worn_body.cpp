// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/serve/worn_body.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

namespace dermis::out::serve {
namespace {

std::size_t joint_named(const Body& body, const std::string& name) {
  std::size_t index = 0;
  while (index < body.joints.size() && body.joints[index].name != name) ++index;
  return index;
}

}  // namespace

WornBody::WornBody(std::shared_ptr<const BodyParts> parts, std::vector<Carried> arrays)
    : parts_(std::move(parts)),
      arrays_(std::move(arrays)),
      rest_(rest_poses(body())),
      positions_(body().joints.size(), 0.0),
      links_(rest_),
      moves_(arrays_.size()) {}

Status WornBody::set_joints(std::span<const std::string> names, std::span<const double> positions) {
  if (names.size() != positions.size()) return bad_input("name and position: must be lists of one length");
  std::vector<std::size_t> joints;
  for (std::size_t k = 0; k < names.size(); ++k) {
    joints.push_back(joint_named(body(), names[k]));
    if (joints.back() == body().joints.size()) return bad_input(fmt::format("name[{}]: the body has no such joint", k));
    if (!std::isfinite(positions[k])) return bad_input(fmt::format("position[{}]: must be a number", k));
  }
  const std::lock_guard lock(mutex_);
  for (std::size_t k = 0; k < joints.size(); ++k) positions_[joints[k]] = positions[k];
  links_ = link_poses(body(), positions_);
  for (std::size_t k = 0; k < arrays_.size(); ++k) {
    const std::size_t link = arrays_[k].link;
    moves_[k] = links_[link] == rest_[link] ? Pose{} : chained(links_[link], inverse(rest_[link]));
  }
  ++version_;
  return Done{};
}

std::vector<Pose> WornBody::suit_from_links() const {
  const std::lock_guard lock(mutex_);
  return links_;
}

Pose WornBody::suit_from_array(std::size_t array) const {
  const std::lock_guard lock(mutex_);
  return chained(links_[arrays_[array].link], arrays_[array].link_from_array);
}

Pose WornBody::move_of(std::size_t array) const {
  if (version_ == 0) return {};
  const std::lock_guard lock(mutex_);
  return moves_[array];
}

}  // namespace dermis::out::serve
