// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/bytes/bodies/surface.hpp"
#include "dermis/live/suits/live_suit.hpp"
#include "dermis/out/serve/served_suit.hpp"

namespace dermis::out::serve {

/// The contacts of an array where they are now, as a body that moved carries them. Used by the thread of the array
/// alone.
class ContactsInSuit {
 public:
  /// `suit` must outlive it.
  ContactsInSuit(const ServedSuit& suit, std::size_t array);

  /// Takes the contacts of a frame; they are valid until the next.
  void take(const live::suits::ArrayResult& result);

  [[nodiscard]] std::span<const SuitContact> contacts() const noexcept { return contacts_; }

  /// As dermis_msgs/msg/Contacts, of the result that was taken.
  void encode(const live::suits::ArrayResult& result, std::vector<std::uint8_t>& message) const;

 private:
  const ServedArray& array_;
  const std::size_t index_;
  const WornBody* const body_;  // null: nothing moves
  Pose move_{};
  std::vector<SuitContact> moved_;
  std::span<const SuitContact> contacts_;
};

}  // namespace dermis::out::serve
