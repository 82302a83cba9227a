// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>

#include "command_line.hpp"
#include "dermis/out/websocket/server.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// --host, --port, --token and --token-file.
void add_server_options(Command& command, out::websocket::ServerOptions& server, std::string& token_file);

/// The token, where the command line has none: of the file, of DERMIS_TOKEN, or of the credential "token" of systemd.
[[nodiscard]] Status find_token(const std::string& token_file, out::websocket::ServerOptions& server);

/// "http://127.0.0.1:8080/", for who starts the server; "... with its token" where it has one, which is not shown.
[[nodiscard]] std::string server_address(const out::websocket::ServerOptions& server, std::uint16_t port);

}  // namespace dermis::app
