// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/contacts_in_suit.hpp"

#include <optional>

#include "dermis/messages/live_messages.hpp"
#include "dermis/serve/served_suit.hpp"

namespace dermis::serve {

void encode_contacts_in_suit(const std::string& array, const ArraySurface& surface, const live::ArrayResult& result,
                             std::vector<std::uint8_t>& message) {
  std::optional<Vector3> centre;
  if (result.report.centre_of_pressure) centre = surface.at(*result.report.centre_of_pressure).position;
  messages::encode_contacts({array, result.report, result.contacts, centre}, kSuitFrame, message);
}

}  // namespace dermis::serve
