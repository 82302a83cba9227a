// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/topics/contacts_in_suit.hpp"

#include <optional>

#include "dermis/bytes/bodies/body.hpp"
#include "dermis/bytes/ros_messages/live_messages.hpp"

namespace dermis::out::serve {

ContactsInSuit::ContactsInSuit(const ServedSuit& suit, std::size_t array)
    : array_(suit.arrays[array]), index_(array), body_(suit.body.get()) {}

void ContactsInSuit::take(const live::suits::ArrayResult& result) {
  contacts_ = result.contacts;
  if (body_ != nullptr) move_ = body_->move_of(index_);
  if (move_ == Pose{}) return;
  moved_.assign(result.contacts.begin(), result.contacts.end());
  for (SuitContact& contact : moved_) {
    contact.place = {moved(move_, contact.place.position), turned(move_, contact.place.normal)};
    contact.velocity = turned(move_, contact.velocity);
  }
  contacts_ = moved_;
}

void ContactsInSuit::encode(const live::suits::ArrayResult& result, std::vector<std::uint8_t>& message) const {
  std::optional<Vector3> centre;
  if (result.report.centre_of_pressure) {
    centre = array_.surface.at(*result.report.centre_of_pressure).position;
    if (move_ != Pose{}) centre = moved(move_, *centre);
  }
  bytes::ros_messages::encode_contacts({array_.name, result.report, contacts_, centre, result.force.total()},
                                       kSuitFrame, message);
}

}  // namespace dermis::out::serve
