// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/source_uri.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "bytes/devices/number_table.hpp"
#include "bytes/devices/protocols.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/nearest_name.hpp"

namespace dermis::bytes::devices {
namespace {

using files::number_within;

constexpr std::size_t kMaxLength = 4096;
constexpr unsigned kLeastBaud = 50;
constexpr unsigned kMostBaud = 20'000'000;
constexpr double kMostSeconds = 1e6;
constexpr double kMostRate = 1e6;
constexpr std::chrono::seconds kReconnect{10};

struct Scheme {
  std::string_view name;
  Transport transport;
  std::set<std::string> parameters;  ///< Besides those of the protocols.
  bool is_source;
  bool is_target;
};

const std::set<std::string> kProtocolParameters = {
    "protocol",  "layout",    "array",     "rows",         "cols",      "nodes_per_packet", "delimited",  "bit_shift",
    "transpose", "flip_rows", "flip_cols", "skip_columns", "row_order", "col_order",        "taxel_order"};

/// Keys of [layout] that hold text, and a number.
const std::set<std::string> kLayoutTexts = {"line",      "line_end", "separator", "comment",       "frame_begin",
                                            "frame_end", "digits",   "escape",    "decimal_point", "unit"};
const std::set<std::string> kLayoutBytes = {"start", "request"};
const std::set<std::string> kLayoutNumbers = {"scale", "offset", "absent", "width"};

const std::array<Scheme, 9>& schemes() {
  static const std::array<Scheme, 9> kAll = {{
      {"serial", Transport::serial, {"baud", "reconnect_s"}, true, true},
      {"tcp", Transport::tcp, {"reconnect_s"}, true, true},
      {"tcp-listen", Transport::tcp_listen, {"reconnect_s"}, true, true},
      {"udp", Transport::udp, {}, true, true},
      {"stdin", Transport::standard_input, {}, true, false},
      {"file", Transport::file, {"rate"}, true, false},
      {"sim",
       Transport::simulation,
       {"rows", "cols", "rate", "seed", "array", "frames", "memory", "gain", "gain_spread"},
       true,
       false},
      {"pty", Transport::pseudo_terminal, {}, false, true},
      {"stdout", Transport::standard_output, {}, false, true},
  }};
  return kAll;
}

/// The text before the first ':' where it looks like the name of a scheme.
std::optional<std::string> scheme_name(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0) return std::nullopt;
  const std::string_view name = text.substr(0, colon);
  const bool is_word = name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-+.") == std::string_view::npos;
  return is_word ? std::optional(std::string(name)) : std::nullopt;
}

const Scheme* find_scheme(std::string_view name) {
  for (const Scheme& scheme : schemes()) {
    if (scheme.name == name) return &scheme;
  }
  return nullptr;
}

std::string joined(const std::set<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// %XX -> the byte; empty where a % is followed by anything else, or stands for 0.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = hex_digit(text[i + 1]);
    const int low = hex_digit(text[i + 2]);
    if (high < 0 || low < 0 || (high == 0 && low == 0)) return std::nullopt;
    decoded += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return decoded;
}

/// "AA 55,values u8" -> ["AA 55", "values u8"]
std::string quoted_list(std::string_view text) {
  std::string list = "[";
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    list += (begin == 0 ? "" : ", ") + files::quoted_toml(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return list + "]";
}

unsigned usual_baud(const std::string& protocol) {
  const ProtocolEntry* const entry = find_protocol(protocol);
  return entry != nullptr ? entry->baud : kUsualBaud;
}

/// A URI on its way into a SourceUri; the first error is kept.
class Parser {
 public:
  Parser(std::string_view text, const Scheme& scheme, const std::set<std::string>& known)
      : text_(text), scheme_(scheme), known_(known) {
    uri_.text = std::string(text);
    uri_.transport = scheme.transport;
    uri_.reconnect = kReconnect;
  }

  Result<SourceUri> parse() {
    std::string_view rest = text_.substr(scheme_.name.size() + 1);
    if (rest.starts_with("//")) rest.remove_prefix(2);
    const std::size_t question = rest.find('?');
    read_place(rest.substr(0, question));
    if (question != std::string_view::npos) split_parameters(rest.substr(question + 1));
    read_parameters();
    if (error_) return *error_;
    return uri_;
  }

 private:
  void fail(const std::string& what) {
    if (!error_) error_ = bad_input("'" + uri_.text + "': " + what);
  }

  void read_place(std::string_view place) {
    switch (uri_.transport) {
      case Transport::serial: return read_path(place, "name the device, as serial:///dev/ttyACM0");
      case Transport::file: return read_path(place, "name the file, as file:/path/of/bytes");
      case Transport::simulation: return read_path(place, "name the scene, as sim:multitouch");
      case Transport::tcp:
      case Transport::tcp_listen:
      case Transport::udp: return read_host_and_port(place);
      case Transport::standard_input:
      case Transport::pseudo_terminal:
      case Transport::standard_output:
        if (!place.empty()) fail("nothing but parameters may follow '" + std::string(scheme_.name) + ":'");
    }
  }

  void read_path(std::string_view place, const char* mend) {
    const std::optional<std::string> path = percent_decoded(place);
    if (!path) return fail("'%' must be followed by two hexadecimal digits other than 00");
    if (path->empty()) return fail(mend);
    uri_.path = *path;
  }

  void read_host_and_port(std::string_view place) {
    const std::string mend = "name host and port, as " + std::string(scheme_.name) + "://127.0.0.1:7000";
    const std::size_t colon = place.rfind(':');
    if (colon == std::string_view::npos) return fail(mend);
    std::string_view host = place.substr(0, colon);
    const bool in_brackets = host.size() > 2 && host.front() == '[' && host.back() == ']';
    if (in_brackets) host = host.substr(1, host.size() - 2);
    if (!in_brackets && host.find(':') != std::string_view::npos) {
      return fail("an IPv6 address stands in brackets, as [::1]:7000");
    }
    if (host.empty() || host.find_first_of("[]/@ ") != std::string_view::npos) return fail(mend);
    const bool may_choose = uri_.transport == Transport::tcp_listen || uri_.transport == Transport::udp;
    const auto port = number_within<std::uint16_t>(place.substr(colon + 1), may_choose ? 0 : 1, 65535);
    if (!port) return fail("the port must be 1 to 65535: " + mend);
    uri_.host = std::string(host);
    uri_.port = *port;
  }

  void split_parameters(std::string_view text) {
    while (!text.empty()) {
      const std::size_t length = std::min(text.find('&'), text.size());
      const std::string_view pair = text.substr(0, length);
      text.remove_prefix(std::min(length + 1, text.size()));
      const std::size_t equals = pair.find('=');
      if (equals == std::string_view::npos) return fail("a parameter is name=value, not '" + std::string(pair) + "'");
      const std::string name(pair.substr(0, equals));
      const std::optional<std::string> value = percent_decoded(pair.substr(equals + 1));
      if (!value) return fail(name + ": '%' must be followed by two hexadecimal digits other than 00");
      if (!known_.contains(name)) return fail(unknown(name));
      if (!parameters_.emplace(name, *value).second) return fail(name + ": is given twice");
    }
  }

  [[nodiscard]] std::string unknown(const std::string& name) const {
    const auto has_it = [&](const Scheme& other) {
      return other.parameters.contains(name) || (other.is_source && kProtocolParameters.contains(name));
    };
    if (std::any_of(schemes().begin(), schemes().end(), has_it)) {
      const std::string which = known_.empty() ? ", which has none" : ", which has " + joined(known_);
      return name + ": is no parameter of " + std::string(scheme_.name) + which;
    }
    const std::string nearest = nearest_name(name, known_);
    if (!nearest.empty()) return "unknown parameter '" + name + "'; did you mean '" + nearest + "'?";
    return "unknown parameter '" + name + (known_.empty() ? "'" : "'; known are " + joined(known_));
  }

  template <typename Number>
  std::optional<Number> read(const char* name, Number least, Number most, const char* range) {
    const auto found = parameters_.find(name);
    if (found == parameters_.end()) return std::nullopt;
    const std::optional<Number> value = number_within<Number>(found->second, least, most);
    if (!value) fail(std::string(name) + ": must be " + range + ", not '" + found->second + "'");
    return value;
  }

  std::optional<FrameShape> read_shape() {
    if (parameters_.contains("rows") != parameters_.contains("cols")) fail("give rows and cols, or neither");
    const auto rows = read<std::size_t>("rows", 1, kMaxLines, "1 to 1024");
    const auto cols = read<std::size_t>("cols", 1, kMaxLines, "1 to 1024");
    if (!rows || !cols) return std::nullopt;
    return FrameShape{*rows, *cols};
  }

  bool read_switch(const char* name) { return read<int>(name, 0, 1, "0 or 1").value_or(0) == 1; }

  void read_list(const char* name, std::vector<std::size_t>& list) {
    const auto found = parameters_.find(name);
    if (found == parameters_.end()) return;
    const std::optional<NumberTable> table = number_table(found->second, kMaxLines - 1);
    if (!table || table->rows > 1) return fail(std::string(name) + ": must be lines from 0 on, such as 0,2,1");
    list = table->numbers;
  }

  void read_taxel_order(LineOrder& order) {
    const auto found = parameters_.find("taxel_order");
    if (found == parameters_.end()) return;
    const auto shape = read_shape();
    if (!shape) return fail("taxel_order: needs rows and cols of what is sent");
    const std::optional<NumberTable> table = number_table(found->second, kMaxLines * kMaxLines - 1);
    if (!table) return fail("taxel_order: must be readings from 0 on, row by row, such as 0,2;1,3");
    std::tie(order.taxel_order, order.taxel_rows, order.taxels_sent) = std::tie(table->numbers, table->rows, *shape);
  }

  void read_order() {
    LineOrder& order = uri_.order;
    order.transpose = read_switch("transpose");
    order.flip_rows = read_switch("flip_rows");
    order.flip_cols = read_switch("flip_cols");
    order.skip_columns = read<std::size_t>("skip_columns", 0, kMaxLines - 1, "0 to 1023").value_or(0);
    read_list("row_order", order.row_order);
    read_list("col_order", order.col_order);
    read_taxel_order(order);
    if (const Status valid = order.validate(); !valid) fail(valid.error().message);
  }

  void read_parameters() {
    if (uri_.transport == Transport::simulation) return read_simulation();
    read_protocol();
    read_order();
    uri_.baud =
        read<unsigned>("baud", kLeastBaud, kMostBaud, "50 to 20000000").value_or(usual_baud(uri_.protocol.name));
    read_rate();
    if (const auto seconds = read<double>("reconnect_s", 0.0, kMostSeconds, "0 to 1e6 seconds")) {
      uri_.reconnect = std::chrono::duration_cast<Nanos>(std::chrono::duration<double>(*seconds));
    }
  }

  /// [layout] in TOML, of the parameters that are its keys; empty where there is none.
  std::string layout_keys() {
    std::string keys;
    for (const auto& [name, value] : parameters_) {
      if (kLayoutTexts.contains(name)) keys += name + " = " + files::quoted_toml(value) + "\n";
      if (kLayoutBytes.contains(name)) keys += name + " = " + files::bytes_toml(value) + "\n";
      if (name == "packet") keys += name + " = " + quoted_list(value) + "\n";
      if (!kLayoutNumbers.contains(name)) continue;
      if (!number_within<double>(value, -1e300, 1e300))
        fail(std::string(name).append(": must be a number, not ").append(value));
      keys.append(name).append(" = ").append(value).append("\n");
    }
    if (keys.empty()) return keys;
    if (!parameters_.contains("line") && !parameters_.contains("packet")) {
      fail(keys.substr(0, keys.find(' ')) + ": is of a layout; give line or packet, too");
    }
    if (!uri_.protocol.shape) fail("line, packet: give rows and cols, too");
    const FrameShape shape = uri_.protocol.shape.value_or(FrameShape{1, 1});
    return "[layout]\nrows = " + std::to_string(shape.rows) + "\ncols = " + std::to_string(shape.cols) + "\n" + keys;
  }

  void read_protocol() {
    if (const auto found = parameters_.find("protocol"); found != parameters_.end()) {
      uri_.protocol.name = found->second;
    }
    if (const auto found = parameters_.find("layout"); found != parameters_.end()) uri_.protocol.layout = found->second;
    if (const auto found = parameters_.find("array"); found != parameters_.end()) uri_.protocol.array = found->second;
    uri_.protocol.is_whole_file = uri_.transport == Transport::file;
    uri_.protocol.shape = read_shape();
    const bool has_file = !uri_.protocol.layout.empty();
    uri_.protocol.layout_keys = layout_keys();
    if (has_file && !uri_.protocol.layout_keys.empty()) fail("layout: give it or its keys, not both");
    const bool has_layout = has_file || !uri_.protocol.layout_keys.empty();
    if (has_layout && parameters_.contains("protocol")) fail("layout: give it or protocol, not both");
    if (!has_file && parameters_.contains("array")) fail("array: is of a layout, which is not given");
    const auto nodes = read<std::size_t>("nodes_per_packet", 1, 32767, "1 to 32767");
    if (nodes) uri_.protocol.nodes_per_packet = *nodes;
    if (const auto shift = read<int>("bit_shift", 5, 6, "5 or 6")) uri_.protocol.bit_shift = *shift;
    const bool is_network =
        uri_.transport == Transport::tcp || uri_.transport == Transport::tcp_listen || uri_.transport == Transport::udp;
    uri_.protocol.delimited = !is_network;
    uri_.protocol.datagrams = uri_.transport == Transport::udp;
    if (const auto found = parameters_.find("delimited"); found != parameters_.end()) {
      if (found->second != "true" && found->second != "false") fail("delimited: must be true or false");
      uri_.protocol.delimited = found->second == "true";
    }
  }

  void read_rate() {
    uri_.rate_hz = read<double>("rate", std::nextafter(0.0, 1.0), kMostRate, "above 0 and at most 1e6 frames a second");
  }

  void read_simulation() {
    uri_.array_shape = read_shape();
    read_rate();
    uri_.seed = read<std::uint64_t>("seed", 0, ~std::uint64_t{0}, "a whole number of 0 or more").value_or(1);
    uri_.frames = read<std::size_t>("frames", 1, 200'000, "1 to 200000");
    if (const auto found = parameters_.find("array"); found != parameters_.end()) uri_.array = found->second;
    if (const auto found = parameters_.find("memory"); found != parameters_.end()) uri_.memory = found->second;
    uri_.gain = read<double>("gain", 0.1, 10.0, "0.1 to 10").value_or(1.0);
    uri_.gain_spread = read<double>("gain_spread", 0.0, 1.0, "0 to 1").value_or(0.0);
  }

  std::string_view text_;
  const Scheme& scheme_;
  const std::set<std::string>& known_;
  SourceUri uri_;
  std::map<std::string, std::string> parameters_;
  std::optional<Error> error_;
};

std::string scheme_list(bool Scheme::*direction) {
  std::set<std::string> names;
  for (const Scheme& scheme : schemes()) {
    if (scheme.*direction) names.insert(std::string(scheme.name) + ":");
  }
  return joined(names);
}

Result<SourceUri> parse(std::string_view text, bool Scheme::*direction) {
  if (text.size() > kMaxLength) return bad_input("a URI of more than 4096 characters");
  if (text.find('\0') != std::string_view::npos) return bad_input("a URI with a byte of 0");
  const std::optional<std::string> name = scheme_name(text);
  const Scheme* scheme = name ? find_scheme(*name) : nullptr;
  if (scheme == nullptr || !(scheme->*direction)) {
    return bad_input("'" + std::string(text) + "': begins with none of " + scheme_list(direction));
  }
  std::set<std::string> known = scheme->parameters;
  const bool is_decoded = direction == &Scheme::is_source && scheme->transport != Transport::simulation;
  if (is_decoded) {
    for (const auto& names : {kProtocolParameters, kLayoutTexts, kLayoutBytes, kLayoutNumbers})
      known.insert(names.begin(), names.end());
    known.insert("packet");
  }
  if (direction == &Scheme::is_target) known.erase("reconnect_s");
  return Parser(text, *scheme, known).parse();
}

}  // namespace

bool is_source_uri(std::string_view text) {
  const std::optional<std::string> name = scheme_name(text);
  return name && (find_scheme(*name) != nullptr || text.substr(name->size()).starts_with("://"));
}

Result<SourceUri> parse_source_uri(std::string_view text) {
  return parse(text, &Scheme::is_source);
}

Result<SourceUri> parse_target_uri(std::string_view text) {
  return parse(text, &Scheme::is_target);
}

}  // namespace dermis::bytes::devices
