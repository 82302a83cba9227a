// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/suit_points.hpp"

namespace dermis::serve {

SuitPoints::SuitPoints(const ServedSuit& suit) {
  for (const ServedArray& array : suit.arrays) {
    Part& part = arrays_.emplace_back();
    for (const SurfacePoint& taxel : array.surface.taxels()) {
      messages::TaxelPoint& point = part.points.emplace_back();
      point.x = static_cast<float>(taxel.position.x);
      point.y = static_cast<float>(taxel.position.y);
      point.z = static_cast<float>(taxel.position.z);
    }
  }
}

void SuitPoints::keep(std::size_t array, const ForceFrame& force) {
  Part& part = arrays_[array];
  const std::lock_guard lock(part.mutex);
  for (std::size_t k = 0; k < force.newtons.size(); ++k) {
    part.points[k].newtons = force.newtons[k];
    part.points[k].status = force.taxels[k];
  }
}

void SuitPoints::encode(Nanos time, std::vector<std::uint8_t>& message) {
  all_.clear();
  for (Part& part : arrays_) {
    const std::lock_guard lock(part.mutex);
    all_.insert(all_.end(), part.points.begin(), part.points.end());
  }
  messages::encode_points(all_, time, kSuitFrame, message);
}

}  // namespace dermis::serve
