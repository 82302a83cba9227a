// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "fleet/broker.hpp"

#include "dermis/core/plugin.hpp"

namespace dermis::fleet {

Result<std::unique_ptr<Broker>> connect_broker(const BrokerAddress& address) {
  const Result<void*> function = find_plugin_function(
      {"NATS", "libdermis_nats.so", "of a build with DERMIS_BUILD_NATS, and its library (Debian: libnats3.4)"},
      kConnectBroker);
  if (!function) return function.error();
  Result<std::unique_ptr<Broker>> connected{std::unique_ptr<Broker>()};
  reinterpret_cast<ConnectBroker>(*function)(address, connected);
  return connected;
}

}  // namespace dermis::fleet
