// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "secrets.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "dermis/bytes/system/secret.hpp"
#include "dermis/live/fleet/stream_address.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

constexpr std::string_view kToken = "--token";

std::string_view token_in(std::string_view argument, std::string_view before) {
  if (before == kToken) return argument;
  const bool is_token = argument.starts_with(kToken) && argument.substr(kToken.size()).starts_with('=');
  return is_token ? argument.substr(kToken.size() + 1) : std::string_view();
}

/// Who is named alone is a user where there is a password elsewhere, and else a token of NATS.
std::string_view password_in(std::string_view argument) {
  const std::string_view scheme = argument.substr(0, argument.find("://"));
  if (!scheme.ends_with("nats") && !scheme.ends_with("tls")) return {};
  const std::string_view user = live::fleet::user_info(argument);
  const std::size_t colon = user.find(':');
  if (colon != std::string_view::npos) return user.substr(colon + 1);
  if (argument.find("password-file=") != std::string_view::npos) return {};
  const Result<std::string> elsewhere = read_secret(live::fleet::password_places());
  return elsewhere && elsewhere->empty() ? user : std::string_view();
}

/// "nats://anna@hub" of "nats://anna:secret@hub", and "nats://hub" of "nats://secret@hub" and "nats://:secret@hub".
std::string without(std::string_view secret, std::string_view argument) {
  std::string text(argument);
  const auto begin = static_cast<std::size_t>(secret.data() - argument.data());
  text.erase(begin, secret.size());
  if (text[begin - 1] == ':') text.erase(begin - 1, 1);
  const std::size_t end = text.find("://@");
  return end == std::string::npos ? text : text.erase(end + 3, 1);
}

void hide(char* argument, std::string_view secret) {
  std::fill_n(argument + (secret.data() - argument), secret.size(), 'x');
}

}  // namespace

Result<std::vector<std::string>> take_arguments(std::span<char* const> arguments) {
  std::vector<std::string> taken(arguments.begin(), arguments.end());
  const std::string variable = live::fleet::password_places().environment;
  std::string password;
  bool has_token = false;
  for (std::size_t k = 1; k < arguments.size(); ++k) {
    if (const std::string_view token = token_in(arguments[k], taken[k - 1]); !token.empty()) {
      hide(arguments[k], token);
      has_token = true;
    }
    const std::string_view secret = password_in(arguments[k]);
    if (secret.empty()) continue;
    if (!password.empty() && password != secret) {
      return bad_input("these hubs have different passwords: give each by password-file=FILE in its address");
    }
    password = secret;
    taken[k] = without(secret, arguments[k]);
    hide(arguments[k], secret);
  }
  if (has_token) print_notice("--token: others could see it in ps; give it by --token-file FILE or DERMIS_TOKEN");
  if (password.empty()) return taken;
  print_notice("the password in an address: others could see it in ps; give it by password-file=FILE or " + variable);
  ::setenv(variable.c_str(), password.c_str(), 1);
  return taken;
}

}  // namespace dermis::app
