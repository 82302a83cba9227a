// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/buses/register_map.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <set>
#include <utility>

#include "dermis/bytes/files/config_table.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/nearest_name.hpp"

namespace dermis::live::buses {
namespace {

using bytes::files::ConfigFile;

constexpr std::size_t kMostWords = 125;  // of a question (Modbus Application Protocol 1.1b3, 6.3)
constexpr std::size_t kMostArrays = 256;
constexpr std::size_t kAddresses = 65536;
const std::vector<std::string> kValues = {"u16", "i16", "u32", "i32", "f32"};

class MapReader {
 public:
  explicit MapReader(ConfigFile file) : file_(std::move(file)) {}

  Result<RegisterMap> read() {
    std::size_t table = 0;
    file_.choice("registers.table", {"holding", "input"}, table);
    map_.input = table == 1;
    map_.address_step = static_cast<unsigned>(count("registers.address_step", map_.address_step, 1, 2));
    map_.port = static_cast<std::uint16_t>(count("registers.port", map_.port, 1, kAddresses - 1));
    map_.unit = static_cast<int>(count("registers.unit", static_cast<std::size_t>(map_.unit), 1, 247));
    const std::size_t arrays = file_.table_count("registers.array");
    if (arrays < 1 || arrays > kMostArrays) file_.fail("registers.array", "there must be 1 to 256");
    for (std::size_t k = 0; k < std::min(arrays, kMostArrays); ++k) {
      read_array("registers.array[" + std::to_string(k) + "].");
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

  void read_array(const std::string& table) {
    RegisterArray array;
    file_.require(table + "name");
    file_.text(table + "name", array.name);
    if (!names_.insert(array.name).second) file_.fail(table + "name", "'" + array.name + "' is there twice");
    array.shape.rows = required_count(table + "rows", 1, kMaxLines);
    array.shape.cols = required_count(table + "cols", 1, kMaxLines);
    array.address = static_cast<std::uint16_t>(required_count(table + "address", 0, kAddresses - 1));
    std::size_t value = 0;
    file_.choice(table + "value", kValues, value);
    array.value = static_cast<RegisterValue>(value);
    std::size_t order = 0;
    file_.choice(table + "order", {"rows", "columns"}, order);
    array.by_columns = order == 1;
    file_.boolean(table + "low_word_first", array.low_word_first);
    file_.boolean(table + "last_row_first", array.last_row_first);
    file_.number(table + "scale", array.scale);
    file_.number(table + "offset", array.offset);
    if (array.address + array.words() * map_.address_step > kAddresses) {
      file_.fail(table + "address", "the array ends behind address 65535");
    }
    map_.arrays.push_back(std::move(array));
  }

  ConfigFile file_;
  RegisterMap map_;
  std::set<std::string> names_;
};

double number_at(const RegisterArray& array, std::span<const std::uint16_t> words, std::size_t index) {
  if (array.value == RegisterValue::u16) return words[index];
  if (array.value == RegisterValue::i16) return static_cast<std::int16_t>(words[index]);
  std::uint32_t high = words[2 * index];
  std::uint32_t low = words[2 * index + 1];
  if (array.low_word_first) std::swap(high, low);
  const std::uint32_t bits = high << 16U | low;
  if (array.value == RegisterValue::i32) return static_cast<std::int32_t>(bits);
  if (array.value == RegisterValue::f32) return std::bit_cast<float>(bits);
  return bits;
}

Error unknown_map(const std::string& name) {
  std::string known;
  for (const std::string& one : known_register_maps()) known += (known.empty() ? "" : ", ") + one;
  const std::vector<std::string> names = known_register_maps();
  const std::string nearest = nearest_name(name, {names.begin(), names.end()});
  if (!nearest.empty()) return bad_input("map=" + name + ": did you mean '" + nearest + "'?");
  return bad_input("map=" + name + ": is not known; known are " + known + ", and any file that ends in .toml");
}

}  // namespace

Result<RegisterMap> read_register_map(const std::string& name_or_path) {
  const std::string_view known = known_register_map(name_or_path);
  if (!known.empty()) return register_map_from_toml(known, name_or_path);
  if (!name_or_path.ends_with(".toml")) return unknown_map(name_or_path);
  Result<ConfigFile> file = ConfigFile::read(name_or_path);
  if (!file) return file.error();
  return MapReader(*std::move(file)).read();
}

Result<RegisterMap> register_map_from_toml(std::string_view text, const std::string& name) {
  Result<ConfigFile> file = ConfigFile::parse(text, name);
  if (!file) return file.error();
  return MapReader(*std::move(file)).read();
}

std::vector<RegisterRead> plan_reads(const RegisterMap& map, std::span<const std::size_t> arrays) {
  std::vector<std::size_t> order(arrays.begin(), arrays.end());
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return map.arrays[a].address < map.arrays[b].address; });
  std::vector<RegisterRead> reads;
  for (const std::size_t index : order) {
    const std::size_t total = map.arrays[index].words();
    for (std::size_t begin = 0; begin < total; begin += kMostWords) {
      const std::size_t words = std::min(kMostWords, total - begin);
      const std::size_t address = map.arrays[index].address + begin * map.address_step;
      const bool follows = !reads.empty() && reads.back().words + words <= kMostWords &&
                           reads.back().address + reads.back().words * map.address_step == address;
      if (!follows) reads.push_back({static_cast<std::uint16_t>(address), 0, {}});
      RegisterRead& read = reads.back();
      read.parts.push_back({index, begin, read.words, words});
      read.words += words;
    }
  }
  return reads;
}

void decode_registers(const RegisterArray& array, std::span<const std::uint16_t> words, RawFrame& frame) {
  assert(words.size() == array.words());
  const auto& [rows, cols] = array.shape;
  frame.counts.resize(rows * cols);
  for (std::size_t index = 0; index < rows * cols; ++index) {
    std::size_t row = array.by_columns ? index % rows : index / cols;
    const std::size_t col = array.by_columns ? index / rows : index % cols;
    if (array.last_row_first) row = rows - 1 - row;
    frame.counts[row * cols + col] = static_cast<float>(array.scale * number_at(array, words, index) + array.offset);
  }
}

}  // namespace dermis::live::buses
