// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The table of array.toml in docs/array-toml.md against what the reader does.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "dermis/bytes/files/array_toml.hpp"
#include "support/places.hpp"

namespace dermis::bytes::files {
namespace {

/// Key and what the column "default" says, without its backticks; one row for each key of a row that names several.
std::vector<std::pair<std::string, std::string>> documented_keys() {
  std::ifstream page(support::project_folder() / "docs/array-toml.md");
  std::vector<std::pair<std::string, std::string>> keys;
  const std::regex row(R"(^\| (`[^|]*`) \|[^|]*\| ([^|]*) \|.*)");
  const std::regex name("`([a-z_.]+)`");
  std::string line;
  while (std::getline(page, line)) {
    std::smatch cells;
    if (!std::regex_match(line, cells, row)) continue;
    const std::string names = cells[1];
    std::string value = cells[2];
    std::erase(value, '`');
    for (std::sregex_iterator key(names.begin(), names.end(), name), end; key != end; ++key) {
      keys.emplace_back((*key)[1], value);
    }
  }
  return keys;
}

using Keys = std::map<std::string, std::string>;

/// What array.toml must have.
Keys required_keys(const std::string& circuit) {
  return {{"array.rows", "2"},         {"array.cols", "3"},         {"readout.circuit", '"' + circuit + '"'},
          {"readout.drive_ohm", "20"}, {"readout.load_ohm", "200"}, {"readout.adc_bits", "12"}};
}

Result<ArrayDescription> read(const Keys& keys) {
  std::string text;
  for (const auto& [key, value] : keys) text.append(key).append(" = ").append(value).append("\n");
  return array_from_toml(text, "array.toml");
}

/// As array.toml, without lines that say of every line of taxels what is so without them.
std::string text_of(const Result<ArrayDescription>& array) {
  EXPECT_TRUE(array) << array.error().message;
  if (!array) return {};
  return std::regex_replace(array_to_toml(*array), std::regex("\n[a-z_]+(ohm|offset_v) = 0(?=\n)"), "");
}

TEST(DocumentedDefaults, what_is_required_is_required) {
  for (const auto& [key, value] : documented_keys()) {
    if (!value.starts_with("required")) continue;
    Keys keys = required_keys("divider");
    EXPECT_EQ(keys.erase(key), 1U) << key;
    const auto array = read(keys);
    ASSERT_FALSE(array) << key;
    EXPECT_NE(array.error().message.find(key), std::string::npos) << array.error().message;
  }
}

TEST(DocumentedDefaults, saying_the_default_changes_nothing) {
  int compared = 0;
  for (const auto& [key, value] : documented_keys()) {
    if (value.starts_with("required") || value == "none" || value == "infinite") continue;
    SCOPED_TRACE(key);
    const bool is_of_amplifiers = key == "readout.column_switch_ohm" || key == "readout.amplifier_offset_v";
    Keys keys = required_keys(is_of_amplifiers ? "transimpedance" : "divider");
    keys["readout.supply_v"] = "5";
    const std::string left_out = text_of(read(keys));
    keys[key] = value;
    EXPECT_EQ(text_of(read(keys)), left_out);
    ++compared;
  }
  EXPECT_GE(compared, 12);
}

TEST(DocumentedDefaults, every_key_is_documented) {
  Keys keys = required_keys("transimpedance");
  for (const char* const key : {"array.taxel_area_mm2", "readout.column_switch_ohm", "readout.amplifier_offset_v",
                                "readout.amplifier_gain", "readout.row_segment_ohm", "readout.column_segment_ohm"}) {
    keys[key] = "1";
  }
  keys["readout.supply_v"] = "5";
  const std::string text = text_of(read(keys)) + text_of(read(required_keys("divider")));
  const auto documented = documented_keys();
  const std::regex key("\n([a-z_]+) = ");
  for (std::sregex_iterator line(text.begin(), text.end(), key), end; line != end; ++line) {
    const std::string name = '.' + (*line)[1].str();
    EXPECT_TRUE(std::any_of(documented.begin(), documented.end(), [&](const auto& row) {
      return row.first.ends_with(name);
    })) << name;
  }
}

}  // namespace
}  // namespace dermis::bytes::files
