// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/topics/suit_transforms.hpp"

namespace dermis::out::serve {

std::vector<bytes::ros_messages::Transform> suit_transforms(const ServedSuit& suit) {
  std::vector<bytes::ros_messages::Transform> transforms;
  for (std::size_t k = 0; k < suit.arrays.size(); ++k) {
    const ServedArray& array = suit.arrays[k];
    transforms.push_back({kSuitFrame, array.name, suit.body ? suit.body->suit_from_array(k) : array.suit_from_array});
  }
  if (!suit.body) return transforms;
  const std::vector<Pose> links = suit.body->suit_from_links();
  for (std::size_t k = 0; k < links.size(); ++k) {
    transforms.push_back({kSuitFrame, "body/" + suit.body->body().links[k].name, links[k]});
  }
  return transforms;
}

}  // namespace dermis::out::serve
