// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/buses/can_map.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "dermis/bytes/files/config_table.hpp"
#include "dermis/bytes/files/numbers.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/nearest_name.hpp"

namespace dermis::live::buses {
namespace {

using bytes::files::ConfigFile;

constexpr std::size_t kMostArrays = 256;
constexpr std::size_t kMostBytes = 64;
constexpr std::size_t kMostId = 0x1FFFFFFF;
constexpr std::string_view kPlaces = R"(must be "byte 1", "high nibble 1", "low nibble 1" or "identifier")";
const std::vector<std::string> kValues = {"u8", "i8", "u16be", "u16le", "i16be", "i16le", "f32be", "f32le"};

std::optional<CanPlace> place_of(std::string_view text) {
  using Kind = CanPlace::Kind;
  if (text == "identifier") return CanPlace{Kind::identifier, 0};
  for (const auto& [word, kind] : {std::pair<std::string_view, Kind>{"byte ", Kind::byte},
                                   {"high nibble ", Kind::high_nibble},
                                   {"low nibble ", Kind::low_nibble}}) {
    if (!text.starts_with(word)) continue;
    const auto byte =
        bytes::files::number_within<std::size_t>(std::string(text.substr(word.size())), 0, kMostBytes - 1);
    return byte ? std::optional(CanPlace{kind, *byte}) : std::nullopt;
  }
  return std::nullopt;
}

/// "B1 C6"
std::optional<std::vector<std::uint8_t>> bytes_of(std::string text) {
  std::vector<std::uint8_t> found;
  std::erase(text, ' ');
  const auto digit = [](char c) -> unsigned {
    constexpr std::string_view kDigits = "0123456789abcdef";
    return static_cast<unsigned>(kDigits.find(static_cast<char>(c | 0x20)));
  };
  for (std::size_t k = 0; k + 1 < text.size(); k += 2) {
    const unsigned high = digit(text[k]);
    const unsigned low = digit(text[k + 1]);
    if (high > 15 || low > 15) return std::nullopt;
    found.push_back(static_cast<std::uint8_t>(high << 4U | low));
  }
  if (text.size() % 2 != 0 || found.size() > kMostBytes) return std::nullopt;
  return found;
}

/// The byte behind what a place reads.
std::size_t end_of(const CanPlace& place) {
  return place.kind == CanPlace::Kind::nowhere || place.kind == CanPlace::Kind::identifier ? 0 : place.byte + 1;
}

class MapReader {
 public:
  explicit MapReader(ConfigFile file) : file_(std::move(file)) {}

  Result<CanMap> read() {
    const std::size_t arrays = file_.table_count("can.array");
    if (arrays < 1 || arrays > kMostArrays) file_.fail("can.array", "there must be 1 to 256");
    for (std::size_t k = 0; k < std::min(arrays, kMostArrays); ++k) {
      read_array("can.array[" + std::to_string(k) + "].");
    }
    if (Status finished = file_.finish(); !finished) return finished.error();
    return std::move(map_);
  }

 private:
  std::size_t count(const std::string& key, std::size_t value, std::size_t least, std::size_t most) {
    file_.count(key, value);
    if (value >= least && value <= most) return value;
    file_.fail(key, "must be " + std::to_string(least) + " to " + std::to_string(most));
    return least;
  }

  std::size_t required_count(const std::string& key, std::size_t least, std::size_t most) {
    file_.require(key);
    return count(key, least, least, most);
  }

  void read_place(const std::string& key, CanPlace& place) {
    std::string text;
    file_.text(key, text);
    if (text.empty()) return;
    const std::optional<CanPlace> found = place_of(text);
    if (!found) return file_.fail(key, std::string(kPlaces));
    place = *found;
  }

  void read_bytes(const std::string& key, std::vector<std::uint8_t>& to) {
    std::string text;
    file_.text(key, text);
    const auto found = bytes_of(text);
    if (!found) return file_.fail(key, "must be bytes in hexadecimal digits, such as \"B1 C6\"");
    to = *found;
  }

  void read_array(const std::string& table) {
    CanArray array;
    file_.require(table + "name");
    file_.text(table + "name", array.name);
    if (!names_.insert(array.name).second) file_.fail(table + "name", "'" + array.name + "' is there twice");
    array.shape.rows = required_count(table + "rows", 1, kMaxLines);
    array.shape.cols = required_count(table + "cols", 1, kMaxLines);
    array.id = static_cast<std::uint32_t>(required_count(table + "id", 0, kMostId));
    read_bytes(table + "begins", array.begins);
    read_parts(table, array);
    read_readings(table, array);
    read_bytes(table + "request", array.request);
    array.request_id = static_cast<std::uint32_t>(count(table + "request_id", array.id, 0, kMostId));
    map_.arrays.push_back(std::move(array));
  }

  void read_parts(const std::string& table, CanArray& array) {
    read_place(table + "part", array.part);
    read_place(table + "row", array.row);
    read_place(table + "col", array.col);
    const auto is_there = [](const CanPlace& place) { return place.kind != CanPlace::Kind::nowhere; };
    if (is_there(array.part) && is_there(array.row)) file_.fail(table + "part", "and row cannot both be there");
    if (is_there(array.col) && !is_there(array.row)) file_.fail(table + "col", "needs a row");
    const std::size_t behind =
        std::max({array.begins.size(), end_of(array.part), end_of(array.row), end_of(array.col)});
    array.first = count(table + "first", behind, 0, kMostBytes - 1);
    const std::size_t most = array.shape.taxel_count();
    array.each = count(table + "each", 0, 0, most);
    if (is_there(array.part) && array.each == 0) file_.fail(table + "each", "must say how many readings a part holds");
  }

  void read_readings(const std::string& table, CanArray& array) {
    std::size_t value = 0;
    file_.choice(table + "value", kValues, value);
    array.value = static_cast<CanValue>(value);
    std::size_t order = 0;
    file_.choice(table + "order", {"rows", "columns"}, order);
    array.by_columns = order == 1;
    if (array.by_columns && array.row.kind != CanPlace::Kind::nowhere) {
      file_.fail(table + "order", "columns go with part, not with row");
    }
    file_.boolean(table + "last_row_first", array.last_row_first);
    file_.number(table + "scale", array.scale);
    file_.number(table + "offset", array.offset);
  }

  ConfigFile file_;
  CanMap map_;
  std::set<std::string> names_;
};

Error unknown_map(const std::string& name) {
  const std::vector<std::string> names = known_can_maps();
  const std::string nearest = nearest_name(name, {names.begin(), names.end()});
  if (!nearest.empty()) return bad_input("map=" + name + ": did you mean '" + nearest + "'?");
  std::string known;
  for (const std::string& one : names) known += (known.empty() ? "" : ", ") + one;
  return bad_input("map=" + name + ": is not known; known are " + known + ", and any file that ends in .toml");
}

}  // namespace

Result<CanMap> read_can_map(const std::string& name_or_path) {
  if (const std::string known = known_can_map(name_or_path); !known.empty()) {
    return can_map_from_toml(known, name_or_path);
  }
  if (!name_or_path.ends_with(".toml")) return unknown_map(name_or_path);
  Result<ConfigFile> file = ConfigFile::read(name_or_path);
  if (!file) return file.error();
  return MapReader(*std::move(file)).read();
}

Result<CanMap> can_map_from_toml(std::string_view text, const std::string& name) {
  Result<ConfigFile> file = ConfigFile::parse(text, name);
  if (!file) return file.error();
  return MapReader(*std::move(file)).read();
}

}  // namespace dermis::live::buses
