// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/live/fleet/stream_address.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// Connects a Hub or a ModelStore to the server of an address that the user gave.
template <typename Served>
Result<std::unique_ptr<Served>> connect_fleet(const std::string& text) {
  const Result<live::fleet::BrokerAddress> address = live::fleet::parse_broker_address(text);
  if (!address) return address.error();
  return Served::connect(*address);
}

}  // namespace dermis::app
