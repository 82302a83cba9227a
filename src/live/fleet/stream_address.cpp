// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/stream_address.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <set>

#include "dermis/touch/frames/nearest_name.hpp"
#include "live/fleet/parse_utc.hpp"

namespace dermis::live::fleet {
namespace {

constexpr std::size_t kMostCharacters = 4096;
constexpr std::size_t kMostOfAName = 64;

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

bool is_of_name(char c) {
  return is_letter_or_digit(c) || c == '_' || c == '-';
}

struct ParsedText {
  std::string url;  // without the user
  std::string user;
  std::map<std::string, std::string> values;
};

Error wrong(const std::string& text, const std::string& what) {
  return bad_input("'" + without_user_info(text) + "': " + what);
}

Result<ParsedText> parse(const std::string& text, const std::set<std::string>& known) {
  if (text.size() > kMostCharacters) return bad_input("an address of NATS is longer than 4096 characters");
  const std::string user(user_info(text));
  if (user.find_first_of(":/") != std::string::npos) {
    return wrong(text, "a password shows wherever an address does: leave it out, and give it by " +
                           password_places().environment + " or password-file=FILE");
  }
  const std::string shown = without_user_info(text);
  const std::size_t mark = shown.find('?');
  ParsedText parsed{shown.substr(0, mark), user, {}};
  if (parsed.url.find("://") == std::string::npos || parsed.url.ends_with("://")) {
    return wrong(text, "names no server; write nats://HOST or tls://HOST");
  }
  std::string rest = mark == std::string::npos ? "" : shown.substr(mark + 1);
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('&'), rest.size());
    const std::string part = rest.substr(0, end);
    rest.erase(0, end + 1);
    const std::size_t equals = part.find('=');
    const std::string name = part.substr(0, equals);
    if (!known.contains(name)) {
      const std::string near = nearest_name(name, known);
      return wrong(text, "'" + name + "' is no parameter" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
    }
    if (equals == std::string::npos || equals + 1 == part.size()) return wrong(text, name + ": has no value");
    if (!parsed.values.emplace(name, part.substr(equals + 1)).second) return wrong(text, name + ": is there twice");
  }
  return parsed;
}

std::string value_of(const ParsedText& parsed, const char* name) {
  const auto found = parsed.values.find(name);
  return found == parsed.values.end() ? "" : found->second;
}

BrokerAddress broker_of(const ParsedText& parsed) {
  return {.url = parsed.url,
          .ca = value_of(parsed, "ca"),
          .key = value_of(parsed, "key"),
          .user = parsed.user,
          .password_file = value_of(parsed, "password-file")};
}

Result<StreamPlace> place_of(const std::string& text, const std::string& name, const std::string& value,
                             const std::string& newest) {
  if (value == newest) return StreamPlace(Newest{});
  std::uint64_t sequence = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), sequence);
  if (error == std::errc{} && end == value.data() + value.size() && sequence > 0) return StreamPlace(sequence);
  if (const std::optional<Nanos> time = parse_utc(value)) return StreamPlace(*time);
  return wrong(text, name + ": must be a number of the stream from 1 on, a time as 2026-11-28T05:00:00Z, or " + newest);
}

}  // namespace

bool is_stream_address(std::string_view text) {
  return text.starts_with("nats:") || text.starts_with("tls:");
}

std::string_view user_info(std::string_view text) {
  const std::size_t begin = text.find("://");
  std::string_view rest = text.substr(begin == std::string_view::npos ? text.find(':') + 1 : begin + 3);
  rest = rest.substr(0, rest.find('?'));
  const std::size_t at = rest.rfind('@');
  return at == std::string_view::npos ? std::string_view() : rest.substr(0, at);
}

std::string without_user_info(const std::string& text) {
  const std::string_view user = user_info(text);
  if (user.empty()) return text;
  return std::string(text).erase(static_cast<std::size_t>(user.data() - text.data()), user.size() + 1);
}

Status check_name(const std::string& what, const std::string& name) {
  const bool is_good = !name.empty() && name.size() <= kMostOfAName && is_letter_or_digit(name.front()) &&
                       std::all_of(name.begin(), name.end(), is_of_name);
  if (is_good) return Done{};
  return bad_input(what + ": '" + name + "' must be 1 to 64 letters, digits, '_' or '-', a letter or digit first");
}

Result<BrokerAddress> parse_broker_address(const std::string& text) {
  if (!is_stream_address(text)) return wrong(text, "is no address of NATS; write nats://HOST or tls://HOST");
  const Result<ParsedText> parsed = parse(text, {"ca", "key", "password-file"});
  if (!parsed) return parsed.error();
  return broker_of(*parsed);
}

Result<StreamAddress> parse_stream_address(const std::string& text) {
  const Result<ParsedText> parsed = parse(text, {"robot", "array", "from", "to", "ca", "key", "password-file"});
  if (!parsed) return parsed.error();
  StreamAddress address{.text = without_user_info(text), .broker = broker_of(*parsed)};
  address.robot = value_of(*parsed, "robot");
  address.array = value_of(*parsed, "array");
  for (const auto& [what, name] : {std::pair("robot", address.robot), std::pair("array", address.array)}) {
    if (name.empty()) return wrong(text, std::string("lacks ") + what + "=NAME");
    if (const Status good = check_name(what, name); !good) return wrong(text, good.error().message);
  }
  if (const std::string from = value_of(*parsed, "from"); !from.empty()) {
    const Result<StreamPlace> place = place_of(text, "from", from, "new");
    if (!place) return place.error();
    address.from = *place;
  }
  if (const std::string to = value_of(*parsed, "to"); !to.empty()) {
    const Result<StreamPlace> place = place_of(text, "to", to, "last");
    if (!place) return place.error();
    address.to = *place;
    address.ends = true;
  }
  if (address.ends && std::holds_alternative<Newest>(address.from)) {
    return wrong(text, "to: needs from, as from=1&to=last");
  }
  return address;
}

std::string stream_of(const std::string& robot) {
  return "dermis_" + robot;
}

std::string subject_of(const std::string& robot, const std::string& array, const char* what) {
  return "dermis." + robot + "." + array + "." + what;
}

std::string health_subject_of(const std::string& robot) {
  return "dermis." + robot + ".health";
}

std::string changes_subject_of(const std::string& robot) {
  return "dermis." + robot + ".changes";
}

}  // namespace dermis::live::fleet
