// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/buses/bus_address.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "dermis/bytes/files/numbers.hpp"
#include "dermis/touch/frames/nearest_name.hpp"

namespace dermis::live::buses {
namespace {

constexpr std::size_t kMostCharacters = 4096;
constexpr std::string_view kTcp = "modbus-tcp:";
constexpr std::string_view kRtu = "modbus-rtu:";
constexpr std::string_view kDds = "dds:";
constexpr std::string_view kCan = "can:";
constexpr std::string_view kCandump = "candump:";

/// An address on its way; the first error is kept.
class Parser {
 public:
  explicit Parser(const std::string& text) : text_(text) {}

  Result<BusAddress> parse() {
    const std::size_t mark = text_.find('?');
    std::string place = text_.substr(0, mark);
    place.erase(0, place.find(':') + 1);
    if (place.starts_with("//")) place.erase(0, 2);
    BusAddress address{.text = text_, .connection = text_.substr(0, mark)};
    if (mark != std::string::npos) split(text_.substr(mark + 1));
    address.array = take("array");
    for (const auto& [name, value] : values_) address.connection.append("&").append(name).append("=").append(value);
    if (text_.starts_with(kDds)) {
      address.place = read_topic(place);
    } else if (text_.starts_with(kCan)) {
      address.place = read_can(place);
    } else if (text_.starts_with(kCandump)) {
      address.place = read_log(place);
    } else {
      address.place = read_modbus(place);
    }
    if (!error_ && !values_.empty()) fail(unknown(values_.begin()->first));
    if (error_) return *error_;
    return address;
  }

 private:
  void fail(const std::string& what) {
    if (!error_) error_ = bad_input("'" + text_ + "': " + what);
  }

  void split(std::string rest) {
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find('&'), rest.size());
      const std::string pair = rest.substr(0, end);
      rest.erase(0, end + 1);
      const std::size_t equals = pair.find('=');
      const std::string name = pair.substr(0, equals);
      if (equals == std::string::npos || equals + 1 == pair.size()) return fail(name + ": has no value");
      if (!values_.emplace(name, pair.substr(equals + 1)).second) return fail(name + ": is given twice");
    }
  }

  std::string take(const char* name) {
    known_.insert(name);
    const auto found = values_.extract(name);
    return found.empty() ? "" : found.mapped();
  }

  template <typename Number>
  std::optional<Number> take_number(const char* name, Number least, Number most, const char* range) {
    const std::string text = take(name);
    if (text.empty()) return std::nullopt;
    const std::optional<Number> value = bytes::files::number_within<Number>(text, least, most);
    if (!value) fail(std::string(name) + ": must be " + range + ", not '" + text + "'");
    return value;
  }

  [[nodiscard]] std::string unknown(const std::string& name) const {
    const std::string nearest = nearest_name(name, known_);
    return "'" + name + "' is no parameter" + (nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
  }

  ModbusPlace read_modbus(const std::string& where) {
    ModbusPlace place;
    const bool is_tcp = text_.starts_with(kTcp);
    if (is_tcp) read_host(where, place);
    if (!is_tcp) place.path = where;
    if (!is_tcp && where.empty()) fail("name the serial line, as modbus-rtu:///dev/ttyUSB0");
    place.map = take_map("the registers of the device");
    place.unit = take_number<int>("unit", 1, 247, "1 to 247").value_or(0);
    place.rate_hz = take_rate();
    if (!is_tcp) place.baud = take_number<unsigned>("baud", 50, 20'000'000, "50 to 20000000").value_or(place.baud);
    place.reconnect = take_reconnect();
    return place;
  }

  std::string take_map(const char* of) {
    std::string map = take("map");
    if (map.empty()) fail(std::string("lacks map=NAME, ") + of);
    return map;
  }

  std::optional<double> take_rate() { return take_number<double>("rate", 1e-3, 1e4, "0.001 to 10000 frames a second"); }

  Nanos take_reconnect() {
    const double seconds = take_number<double>("reconnect_s", 0.0, 1e6, "0 to 1e6 seconds").value_or(10.0);
    return std::chrono::duration_cast<Nanos>(std::chrono::duration<double>(seconds));
  }

  CanInterface read_can(const std::string& where) {
    if (where.empty() || where.find('/') != std::string::npos) fail("name the interface, as can://can0");
    return {where, take_map("the frames of the arrays"), take_rate(), take_reconnect()};
  }

  CanLog read_log(const std::string& where) {
    if (where.empty()) fail("name the log, as candump:hand.log");
    return {where, take_map("the frames of the arrays"), take("interface"), take_rate()};
  }

  void read_host(const std::string& where, ModbusPlace& place) {
    const std::size_t bracket = where.rfind(']');
    const std::size_t colon = where.find(':', bracket == std::string::npos ? 0 : bracket);
    place.host = where.substr(0, colon);
    const bool in_brackets = place.host.size() > 2 && place.host.front() == '[' && place.host.back() == ']';
    if (in_brackets) place.host = place.host.substr(1, place.host.size() - 2);
    if (place.host.empty() || place.host.find_first_of("[]/@ ") != std::string::npos) {
      fail("name the host, as modbus-tcp://192.168.123.210");
    }
    if (colon == std::string::npos) return;
    const auto port = bytes::files::number_within<std::uint16_t>(where.substr(colon + 1), 1, 65535);
    if (!port) return fail("the port must be 1 to 65535");
    place.port = *port;
  }

  TopicPlace read_topic(const std::string& where) {
    TopicPlace place;
    const std::size_t slash = where.find('/');
    const auto domain = bytes::files::number_within<std::uint32_t>(where.substr(0, slash), 0, 232);
    if (!domain) fail("name a domain of 0 to 232, as dds://0/rt/chest/raw");
    place.domain = domain.value_or(0);
    if (slash != std::string::npos) place.topic = where.substr(slash + 1);
    if (place.topic.empty()) fail("names no topic; write it as DDS does, as dds://0/rt/chest/raw");
    place.type = take("type");
    if (place.type.empty()) fail("lacks type=TYPE, such as type=sensor_msgs/msg/Image");
    place.loopback_only = take_number<int>("loopback", 0, 1, "0 or 1").value_or(0) == 1;
    return place;
  }

  const std::string& text_;
  std::map<std::string, std::string> values_;
  std::set<std::string> known_;
  std::optional<Error> error_;
};

}  // namespace

bool is_bus_address(std::string_view text) {
  return std::ranges::any_of(std::array{kTcp, kRtu, kDds, kCan, kCandump},
                             [&](std::string_view scheme) { return text.starts_with(scheme); });
}

Result<BusAddress> parse_bus_address(const std::string& text) {
  if (text.size() > kMostCharacters) return bad_input("an address of more than 4096 characters");
  return Parser(text).parse();
}

std::string map_of(const BusAddress& address) {
  const auto map = [](const auto& place) {
    if constexpr (requires { place.map; }) return place.map;
    return std::string();
  };
  return std::visit(map, address.place);
}

}  // namespace dermis::live::buses
