// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>

#include "dermis/out/websocket/server.hpp"

namespace dermis::app {

/// "http://127.0.0.1:8080/?token=...", for who starts the server.
[[nodiscard]] inline std::string server_address(const out::websocket::ServerOptions& server, std::uint16_t port) {
  const bool is_ipv6 = server.host.find(':') != std::string::npos;
  const std::string host = is_ipv6 ? "[" + server.host + "]" : server.host;
  const std::string token = server.token.empty() ? "" : "?token=" + server.token;
  return "http://" + host + ":" + std::to_string(port) + "/" + token;
}

}  // namespace dermis::app
