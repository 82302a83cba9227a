// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/broker.hpp"

#include "dermis/bytes/system/plugin.hpp"
#include "dermis/bytes/system/secret.hpp"
#include "dermis/live/fleet/model_store.hpp"

namespace dermis::live::fleet {
namespace {

Result<void*> find_function(const char* name) {
  return find_plugin_function(
      {"NATS", "libdermis_nats.so",
       "of a build with DERMIS_BUILD_NATS or of the Debian package dermis, and its library (Debian: libnats3.4)"},
      name);
}

/// A user who has no password is not shown: a token of NATS may stand there.
Result<std::string> password_of(const BrokerAddress& address) {
  Result<std::string> password = read_secret(password_places(address.password_file));
  if (!password || address.user.empty() || !password->empty()) return password;
  return bad_input("'" + address.url + "': its user has no password: give it by " + password_places().environment +
                   " or password-file=FILE; a token, too, without a user");
}

}  // namespace

Result<std::unique_ptr<Broker>> connect_broker(const BrokerAddress& address) {
  const Result<std::string> password = password_of(address);
  if (!password) return password.error();
  const Result<void*> function = find_function(kConnectBroker);
  if (!function) return function.error();
  Result<std::unique_ptr<Broker>> connected{std::unique_ptr<Broker>()};
  reinterpret_cast<ConnectBroker>(*function)(address, *password, connected);
  return connected;
}

Result<std::string> sha256(std::string_view bytes) {
  const Result<void*> function = find_function(kFindSha256);
  if (!function) return function.error();
  std::string digits;
  reinterpret_cast<FindSha256>(*function)(bytes, digits);
  return digits;
}

}  // namespace dermis::live::fleet
