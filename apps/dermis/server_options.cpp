// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "server_options.hpp"

#include "dermis/bytes/system/secret.hpp"

namespace dermis::app {

void add_server_options(Command& command, out::websocket::ServerOptions& server, std::string& token_file) {
  command.option("--host", server.host, "Address to serve at; all but loopback need a token").shows_default();
  command.option("--port", server.port, "Port; 0: any that is free").shows_default();
  const Option token = command.option("--token", server.token, "Every client must present it; others see it here");
  command
      .option("--token-file", token_file,
              "A file with the token as its only line; without it DERMIS_TOKEN, or what systemd loads as 'token'")
      .excludes(token);
}

Status find_token(const std::string& token_file, out::websocket::ServerOptions& server) {
  if (!server.token.empty()) return Done{};
  Result<std::string> token = read_secret({token_file, "DERMIS_TOKEN", "token"});
  if (!token) return token.error();
  server.token = *std::move(token);
  return Done{};
}

std::string server_address(const out::websocket::ServerOptions& server, std::uint16_t port) {
  const bool is_ipv6 = server.host.find(':') != std::string::npos;
  const std::string host = is_ipv6 ? "[" + server.host + "]" : server.host;
  return "http://" + host + ":" + std::to_string(port) + "/" + (server.token.empty() ? "" : " with its token");
}

}  // namespace dermis::app
