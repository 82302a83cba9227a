// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/core/result.hpp"
#include "dermis/fleet/stream_address.hpp"

namespace dermis::app {

/// Connects a Hub, a JobQueue or a ModelStore to the server of an address that the user gave.
template <typename Served>
Result<std::unique_ptr<Served>> connect_fleet(const std::string& text) {
  const Result<fleet::BrokerAddress> address = fleet::parse_broker_address(text);
  if (!address) return address.error();
  return Served::connect(*address);
}

}  // namespace dermis::app
