// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/bodies/wrench.hpp"

#include "bytes/bodies/vector3.hpp"

namespace dermis {

Wrench& operator+=(Wrench& wrench, const Wrench& other) noexcept {
  wrench.force = wrench.force + other.force;
  wrench.torque = wrench.torque + other.torque;
  return wrench;
}

Wrench wrench_of(std::span<const SuitContact> contacts, const Pose& suit_from_frame) noexcept {
  Wrench sum;
  for (const SuitContact& contact : contacts) {
    const Vector3 force = -contact.contact.force_n * contact.place.normal;
    sum += {force, cross(contact.place.position - suit_from_frame.translation, force)};
  }
  const Quaternion& turn = suit_from_frame.rotation;
  const Quaternion back{-turn.x, -turn.y, -turn.z, turn.w};
  return {rotated(back, sum.force), rotated(back, sum.torque)};
}

}  // namespace dermis
