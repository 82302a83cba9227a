// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "fleet/broker.hpp"

#include "dermis/core/plugin.hpp"
#include "fleet/fleet_keys.hpp"

namespace dermis::fleet {
namespace {

Result<void*> find(const char* function) {
  return find_plugin_function(
      {"NATS", "libdermis_nats.so", "of a build with DERMIS_BUILD_NATS, and its library (Debian: libnats3.4)"},
      function);
}

}  // namespace

Result<std::unique_ptr<Broker>> connect_broker(const BrokerAddress& address) {
  const Result<void*> function = find(kConnectBroker);
  if (!function) return function.error();
  Result<std::unique_ptr<Broker>> connected{std::unique_ptr<Broker>()};
  reinterpret_cast<ConnectBroker>(*function)(address, connected);
  return connected;
}

Result<std::unique_ptr<FleetKeys>> load_fleet_keys() {
  const Result<void*> function = find(kMakeFleetKeys);
  if (!function) return function.error();
  std::unique_ptr<FleetKeys> made;
  reinterpret_cast<MakeFleetKeys>(*function)(made);
  return made;
}

}  // namespace dermis::fleet
