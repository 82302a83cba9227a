// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <string>

#include "commands.hpp"
#include "serve/serve_session.hpp"
#include "serve/served_suit.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

struct ServeOptions {
  SuitPlace place;
  std::string record;
  stream::ServerOptions server;
};

Status check(const ServeOptions& options) {
  const SuitPlace& place = options.place;
  if (place.suit.empty() && (place.from.empty() || place.model.empty())) {
    return bad_input("serve: give --from and --model, or --suit");
  }
  if (!place.suit.empty() && !place.model.empty()) return bad_input("--model: suit.toml names the models");
  if (!options.record.empty() && !options.record.ends_with(".mcap")) return bad_input("--record: end it in .mcap");
  return options.server.validate();
}

std::string address(const stream::ServerOptions& server, std::uint16_t port) {
  const bool is_ipv6 = server.host.find(':') != std::string::npos;
  std::string url = fmt::format("http://{}:{}/", is_ipv6 ? "[" + server.host + "]" : server.host, port);
  if (!server.token.empty()) url += "?token=" + server.token;
  return url;
}

Status serve(ServeOptions& options) {
  if (Status possible = check(options); !possible) return possible;
  static_cast<void>(stop_flag());
  Result<ServedSuit> suit = open_served_suit(options.place);
  if (!suit) return suit.error();
  const std::size_t arrays = suit->arrays.size();
  const std::string first = suit->arrays.front().name;
  options.server.notice = say;
  Result<std::unique_ptr<ServeSession>> session =
      ServeSession::create(*std::move(suit), options.server, options.record);
  if (!session) return session.error();
  const std::string what = arrays == 1 ? first : fmt::format("{} arrays", arrays);
  say(fmt::format("serving {} at {} (Ctrl-C ends it)", what, address(options.server, (*session)->port())));
  return (*session)->run();
}

}  // namespace

void add_serve(Command& command) {
  auto options = std::make_shared<ServeOptions>();
  command.option("--from", options->place.from, "URI of a device or of the simulator, or a recording");
  command.option("--model", options->place.model, "Its model, or the array.toml of an array to be calibrated");
  command.option("--suit", options->place.suit, "suit.toml: several arrays with their sources and models");
  command.option("--record", options->record, "Record from the beginning, .mcap");
  command.option("--host", options->server.host, "Address to serve at; all but loopback need a token").shows_default();
  command.option("--port", options->server.port, "Port; 0: any that is free").not_negative().shows_default();
  command.option("--token", options->server.token, "Asked of every client");
  command.action([options] { return serve(*options); });
}

}  // namespace dermis::app
