// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "fleet/broker.hpp"

#include <dlfcn.h>

#include <string>

namespace dermis::fleet {
namespace {

constexpr const char* kPlugin = "libdermis_nats.so";

Error failed_to_load() {
  const char* const why = dlerror();
  return bad_input(std::string("NATS needs ") + kPlugin + " of a build with DERMIS_BUILD_NATS, and its library " +
                   "(Debian: libnats3.4): " + (why != nullptr ? why : "cannot be loaded"));
}

}  // namespace

Result<std::unique_ptr<Broker>> connect_broker(const BrokerAddress& address) {
  // Never closed: threads of the library live as long as the process.
  void* const plugin = dlopen(kPlugin, RTLD_NOW | RTLD_LOCAL);
  if (plugin == nullptr) return failed_to_load();
  const auto connect = reinterpret_cast<ConnectBroker>(dlsym(plugin, kConnectBroker));
  if (connect == nullptr) return failed_to_load();
  Result<std::unique_ptr<Broker>> connected{std::unique_ptr<Broker>()};
  connect(address, connected);
  return connected;
}

}  // namespace dermis::fleet
