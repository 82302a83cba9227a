// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/websocket/server.hpp"
#include "out/websocket/access.hpp"

namespace dermis::out::websocket {
namespace {

constexpr std::size_t kShortestToken = 8;

}  // namespace

bool ServerOptions::is_local() const {
  return is_loopback(host);
}

Status ServerOptions::validate() const {
  if (!is_address(host)) return bad_field("host", "'" + host + "' is no address; give one like 127.0.0.1 or 0.0.0.0");
  if (token.empty() && !is_local()) {
    return bad_field("host", "others could reach " + host + "; give a token that they must know, or use 127.0.0.1");
  }
  if (!token.empty() && token.size() < kShortestToken) return bad_field("token", "must have 8 characters or more");
  if (!is_url_safe(token)) return bad_field("token", "letters, digits and -._~ only, as it stands in a URL");
  if (most_clients < 1 || most_clients > 1000) return bad_input("most_clients: must be 1 ... 1000");
  if (client_queue_bytes < 65'536) return bad_input("client_queue_bytes: must be at least 65536");
  return Done{};
}

}  // namespace dermis::out::websocket
