// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/topics/suit_points.hpp"

namespace dermis::out::serve {

SuitPoints::SuitPoints(const ServedSuit& suit) : body_(suit.body.get()) {
  for (const ServedArray& array : suit.arrays) {
    ArrayPoints& part = arrays_.emplace_back();
    for (const SurfacePoint& taxel : array.surface.taxels()) {
      bytes::ros_messages::TaxelPoint& point = part.points.emplace_back();
      point.x = static_cast<float>(taxel.position.x);
      point.y = static_cast<float>(taxel.position.y);
      point.z = static_cast<float>(taxel.position.z);
    }
  }
}

void SuitPoints::keep(std::size_t array, const ForceFrame& force) {
  ArrayPoints& part = arrays_[array];
  const std::lock_guard lock(part.mutex);
  for (std::size_t k = 0; k < force.newtons.size(); ++k) {
    part.points[k].newtons = force.newtons[k];
    part.points[k].status = force.taxels[k];
  }
}

/// The points of the array, from the first of it in all_ on.
void SuitPoints::move(std::size_t array, std::size_t first) {
  const Pose move = body_->move_of(array);
  if (move == Pose{}) return;
  for (std::size_t k = first; k < all_.size(); ++k) {
    bytes::ros_messages::TaxelPoint& point = all_[k];
    const Vector3 place = moved(move, {point.x, point.y, point.z});
    point.x = static_cast<float>(place.x);
    point.y = static_cast<float>(place.y);
    point.z = static_cast<float>(place.z);
  }
}

void SuitPoints::encode(Nanos time, std::vector<std::uint8_t>& message) {
  all_.clear();
  for (std::size_t array = 0; array < arrays_.size(); ++array) {
    ArrayPoints& part = arrays_[array];
    const std::size_t first = all_.size();
    {
      const std::lock_guard lock(part.mutex);
      all_.insert(all_.end(), part.points.begin(), part.points.end());
    }
    if (body_ != nullptr) move(array, first);
  }
  bytes::ros_messages::encode_points(all_, time, kSuitFrame, message);
}

}  // namespace dermis::out::serve
