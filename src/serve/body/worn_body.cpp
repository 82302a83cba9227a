// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/serve/worn_body.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace dermis::serve {
namespace {

using nlohmann::json;

constexpr std::size_t kMostRequestBytes = std::size_t{64} << 10U;

std::size_t joint_named(const Body& body, const std::string& name) {
  std::size_t index = 0;
  while (index < body.joints.size() && body.joints[index].name != name) ++index;
  return index;
}

using Positions = std::vector<std::pair<std::size_t, double>>;  // of joints

Result<Positions> positions_of(std::string_view request, const Body& body) {
  const json parsed = request.size() <= kMostRequestBytes ? json::parse(request, nullptr, false) : json();
  const json names = parsed.is_object() ? parsed.value("name", json()) : json();
  const json values = parsed.is_object() ? parsed.value("position", json()) : json();
  if (!names.is_array() || !values.is_array() || names.size() != values.size()) {
    return bad_input(R"(must be {"name": [...], "position": [...]}, two lists of one length)");
  }
  Positions positions;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string name = names[k].is_string() ? names[k].get<std::string>() : std::string();
    const std::size_t joint = joint_named(body, name);
    if (joint == body.joints.size()) return bad_input(fmt::format("name[{}]: the body has no such joint", k));
    const double position = values[k].is_number() ? values[k].get<double>() : std::nan("");
    if (!std::isfinite(position)) return bad_input(fmt::format("position[{}]: must be a number", k));
    positions.emplace_back(joint, position);
  }
  return positions;
}

}  // namespace

WornBody::WornBody(std::shared_ptr<const BodyParts> parts, std::vector<Carried> arrays)
    : parts_(std::move(parts)),
      arrays_(std::move(arrays)),
      rest_(rest_poses(body())),
      positions_(body().joints.size(), 0.0),
      links_(rest_),
      moves_(arrays_.size()) {}

Status WornBody::set_joints(std::string_view request) {
  const Result<Positions> positions = positions_of(request, body());
  if (!positions) return positions.error();
  const std::lock_guard lock(mutex_);
  for (const auto& [joint, position] : *positions) positions_[joint] = position;
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

}  // namespace dermis::serve
