// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

#include "dermis/bytes/bodies/surface.hpp"

namespace dermis {

/// Force and torque about the origin of a frame.
struct Wrench {
  Vector3 force{};   ///< [N]
  Vector3 torque{};  ///< [N m]

  bool operator==(const Wrench&) const = default;
};

/// The sum of two in the same frame.
Wrench& operator+=(Wrench& wrench, const Wrench& other) noexcept;

/// The wrench of the contacts on their wearer: each presses with its force against the normal of its place. It is in
/// the frame that `suit_from_frame` places in the suit; without one, in the suit's.
[[nodiscard]] Wrench wrench_of(std::span<const SuitContact> contacts, const Pose& suit_from_frame = {}) noexcept;

}  // namespace dermis
