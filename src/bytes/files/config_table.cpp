// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/config_table.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <set>
#include <utility>

#include "bytes/files/config_text.hpp"
#include "bytes/files/toml_text.hpp"
#include "dermis/bytes/files/file_kind.hpp"
#include "dermis/bytes/files/numbers.hpp"
#include "dermis/touch/frames/nearest_name.hpp"

namespace dermis::bytes::files {
namespace {

std::optional<double> finite_number(const toml::node& node) {
  std::optional<double> number;
  if (const toml::value<double>* real = node.as_floating_point()) number = real->get();
  if (const toml::value<std::int64_t>* whole = node.as_integer()) number = static_cast<double>(whole->get());
  return number && std::isfinite(*number) ? number : std::nullopt;
}

template <typename Integer>
std::optional<Integer> whole_number(const toml::node& node) {
  const std::optional<std::int64_t> whole = node.value_exact<std::int64_t>();
  return whole && std::in_range<Integer>(*whole) ? std::optional(static_cast<Integer>(*whole)) : std::nullopt;
}

std::optional<std::string> text_of(const toml::node& node) {
  return node.value_exact<std::string>();
}

using OptionalWord = std::optional<ConfigFile::Word>;

std::optional<double> finite_number_or(const OptionalWord& word, const toml::node& node) {
  const toml::value<std::string>* text = node.as_string();
  if (word && text != nullptr && text->get() == word->text) return word->number;
  return finite_number(node);
}

std::optional<std::vector<double>> finite_numbers(const toml::array& list, const OptionalWord& word) {
  std::vector<double> numbers;
  for (const toml::node& node : list) {
    const std::optional<double> number = finite_number_or(word, node);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

/// A number, or a list of two that rise.
std::optional<std::pair<double, double>> range_of(const toml::node& node) {
  if (const std::optional<double> number = finite_number(node)) return std::pair(*number, *number);
  const toml::array* list = node.as_array();
  const auto ends = list != nullptr ? finite_numbers(*list, std::nullopt) : std::nullopt;
  const bool is_range = ends && ends->size() == 2 && (*ends)[0] <= (*ends)[1];
  return is_range ? std::optional(std::pair((*ends)[0], (*ends)[1])) : std::nullopt;
}

/// The node of one part of a dotted path: "array", or "array[0]" for a table of a list of tables.
const toml::node* part_of(const toml::table& table, std::string_view part) {
  const std::size_t bracket = part.find('[');
  const toml::node* node = table.get(part.substr(0, bracket));
  if (bracket == std::string_view::npos || node == nullptr) return node;
  const toml::array* list = node->as_array();
  std::size_t place = 0;
  const bool has_place = number_at(part.substr(bracket + 1), place) > 0;
  return list != nullptr && has_place && place < list->size() ? list->get(place) : nullptr;
}

std::string place_in(const std::string& list, std::size_t place) {
  return list + "[" + std::to_string(place) + "]";
}

std::string quoted_list(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 == names.size() ? " or " : ", ";
    list += "\"" + names[i] + "\"";
  }
  return list;
}

}  // namespace

struct ConfigFile::Parsed {
  struct Unknown {
    toml::source_index line = 0;
    std::string key;
    bool is_table = false;
  };

  std::string name;
  toml::table root;
  std::set<std::string> known_keys;
  std::set<std::string> known_tables;
  std::set<std::string> known_table_lists;
  std::optional<Error> first_error;
  bool first_error_is_missing_key = false;

  const toml::node* find(std::string_view key) const {
    const toml::table* table = &root;
    while (table != nullptr) {
      const std::size_t dot = key.find('.');
      const toml::node* node = part_of(*table, key.substr(0, dot));
      if (dot == std::string_view::npos || node == nullptr) return node;
      table = node->as_table();
      key.remove_prefix(dot + 1);
    }
    return nullptr;
  }

  const toml::node* ask(std::string_view key) {
    known_keys.emplace(key);
    for (std::size_t dot = key.find('.'); dot != std::string_view::npos; dot = key.find('.', dot + 1)) {
      known_tables.emplace(key.substr(0, dot));
    }
    return find(key);
  }

  void keep(const toml::node* node, std::string_view key, std::string_view message) {
    if (first_error) return;
    std::string text = name + ":";
    if (node != nullptr) text += std::to_string(node->source().begin.line) + ":";
    text.append(" ").append(key).append(": ").append(message);
    first_error = bad_input(std::move(text));
    first_error_is_missing_key = node == nullptr;
  }

  /// `read(node)`: the value, or nothing where the node is not what is wanted.
  template <typename Value, typename Read>
  void read_value(std::string_view key, const char* wanted, Value& value, const Read& read) {
    const toml::node* node = ask(key);
    if (node == nullptr) return;
    std::optional<Value> found = read(*node);
    if (!found) return keep(node, key, wanted);
    value = *std::move(found);
  }

  /// The same of each element of a list.
  template <typename Value, typename Read>
  void read_values(std::string_view key, const char* wanted, std::vector<Value>& values, const Read& read) {
    const toml::node* node = ask(key);
    if (node != nullptr) read_list_of(*node, key, wanted, values, read);
  }

  template <typename Value, typename Read>
  void read_list_of(const toml::node& node, std::string_view key, const char* wanted, std::vector<Value>& values,
                    const Read& read) {
    const toml::array* list = node.as_array();
    if (list == nullptr) return keep(&node, key, wanted);
    values.clear();
    for (const toml::node& element : *list) {
      std::optional<Value> found = read(element);
      if (!found) return keep(&node, key, wanted);
      values.push_back(*std::move(found));
    }
  }

  void read_list(const toml::node& node, std::string_view key, std::size_t size, const OptionalWord& word,
                 std::string wanted, std::vector<double>& values) {
    const toml::array* list = node.as_array();
    std::optional<std::vector<double>> numbers;
    if (list != nullptr) numbers = finite_numbers(*list, word);
    if (numbers && numbers->size() == size) {
      values = std::move(*numbers);
      return;
    }
    if (numbers) wanted += ", has " + std::to_string(numbers->size());
    keep(&node, key, wanted);
  }

  void read_per_line(std::string_view key, std::size_t size, const OptionalWord& word, const std::string& wanted,
                     std::vector<double>& values) {
    const toml::node* node = ask(key);
    if (node == nullptr) return;
    if (node->is_array()) return read_list(*node, key, size, word, wanted, values);
    const std::optional<double> number = finite_number_or(word, *node);
    if (!number) return keep(node, key, wanted);
    values.assign(size, *number);
  }

  /// The unknown key that stands first in the file.
  void find_unknown(const toml::table& table, const std::string& prefix, std::optional<Unknown>& first) const {
    for (const auto& [key, node] : table) {
      const std::string path = prefix + std::string(key.str());
      if (known_keys.contains(path)) continue;
      if (known_table_lists.contains(path) && node.is_array_of_tables()) {
        find_unknown_in_list(*node.as_array(), path, first);
        continue;
      }
      const toml::table* inner = node.as_table();
      if (inner != nullptr && known_tables.contains(path)) {
        find_unknown(*inner, path + ".", first);
        continue;
      }
      const toml::source_index line = key.source().begin.line;
      if (!first || line < first->line) first = Unknown{line, path, inner != nullptr};
    }
  }

  void find_unknown_in_list(const toml::array& tables, const std::string& path, std::optional<Unknown>& first) const {
    for (std::size_t place = 0; place < tables.size(); ++place) {
      find_unknown(*tables[place].as_table(), place_in(path, place) + ".", first);
    }
  }

  Error describe(const Unknown& unknown) const {
    std::string text = name + ":" + std::to_string(unknown.line) + ": unknown " + (unknown.is_table ? "table" : "key") +
                       " '" + unknown.key + "'";
    std::string nearest = nearest_name(unknown.key, unknown.is_table ? known_tables : known_keys);
    if (nearest.empty()) nearest = nearest_name(unknown.key, known_table_lists);
    if (!nearest.empty()) text += "; did you mean '" + nearest + "'?";
    return bad_input(std::move(text));
  }
};

ConfigFile::ConfigFile() : parsed_(std::make_unique<Parsed>()) {}
ConfigFile::ConfigFile(ConfigFile&&) noexcept = default;
ConfigFile& ConfigFile::operator=(ConfigFile&&) noexcept = default;
ConfigFile::~ConfigFile() = default;

Result<ConfigFile> ConfigFile::read(const std::string& path) {
  const Result<std::string> text = read_config_text(path);
  if (!text) return text.error();
  return parse(*text, path);
}

Result<ConfigFile> ConfigFile::parse(std::string_view text, const std::string& name) {
  if (const auto other = wrong_kind(text, kTomlKind)) return bad_input(name + ": " + *other);
  if (const Status checked = check_config_text(text, name); !checked) return checked.error();
  Result<toml::table> root = parse_toml(with_byte_escapes(text), name);
  if (!root) return root.error();
  ConfigFile file;
  file.parsed_->name = name;
  file.parsed_->root = *std::move(root);
  return file;
}

bool ConfigFile::contains(std::string_view key) const {
  return parsed_->find(key) != nullptr;
}

bool ConfigFile::is_text(std::string_view key, std::string_view text) {
  const toml::node* node = parsed_->ask(key);
  return node != nullptr && node->is_string() && node->as_string()->get() == text;
}

bool ConfigFile::holds_text(std::string_view key) {
  const toml::node* node = parsed_->ask(key);
  return node != nullptr && node->is_string();
}

void ConfigFile::number(std::string_view key, double& value) {
  parsed_->read_value(key, "must be a number", value, finite_number);
}

void ConfigFile::number(std::string_view key, std::optional<double>& value) {
  double present = 0.0;
  number(key, present);
  if (contains(key)) value = present;
}

void ConfigFile::integer(std::string_view key, int& value) {
  parsed_->read_value(key, "must be a whole number", value, whole_number<int>);
}

void ConfigFile::count(std::string_view key, std::size_t& value) {
  parsed_->read_value(key, "must be a whole number of 0 or more", value, whole_number<std::size_t>);
}

void ConfigFile::boolean(std::string_view key, bool& value) {
  parsed_->read_value(key, "must be true or false", value,
                      [](const toml::node& node) { return node.value_exact<bool>(); });
}

void ConfigFile::text(std::string_view key, std::string& value) {
  parsed_->read_value(key, "must be a text in quotes", value, text_of);
}

void ConfigFile::number_per_line(std::string_view key, std::size_t size, std::vector<double>& values) {
  parsed_->read_per_line(key, size, std::nullopt,
                         "must be one number or a list of " + std::to_string(size) + " numbers", values);
}

void ConfigFile::number_per_line(std::string_view key, std::size_t size, const Word& word,
                                 std::vector<double>& values) {
  const std::string wanted =
      "must be a number or \"" + word.text + "\", or a list of " + std::to_string(size) + " of these";
  parsed_->read_per_line(key, size, word, wanted, values);
}

void ConfigFile::numbers(std::string_view key, std::size_t size, std::vector<double>& values) {
  const toml::node* node = parsed_->ask(key);
  if (node == nullptr) return;
  parsed_->read_list(*node, key, size, std::nullopt, "must be a list of " + std::to_string(size) + " numbers", values);
}

void ConfigFile::number_rows(std::string_view key, std::size_t size, std::vector<std::vector<double>>& rows) {
  const toml::node* node = parsed_->ask(key);
  if (node == nullptr) return;
  const std::string wanted = "must be a list of lists of " + std::to_string(size) + " numbers";
  const toml::array* list = node->as_array();
  if (list == nullptr) return parsed_->keep(node, key, wanted);
  rows.clear();
  for (const toml::node& element : *list) {
    const toml::array* inner = element.as_array();
    std::optional<std::vector<double>> numbers;
    if (inner != nullptr) numbers = finite_numbers(*inner, std::nullopt);
    if (!numbers || numbers->size() != size) return parsed_->keep(&element, key, wanted);
    rows.push_back(*std::move(numbers));
  }
}

std::size_t ConfigFile::table_count(std::string_view key) {
  parsed_->known_table_lists.emplace(key);
  const toml::node* node = parsed_->find(key);
  if (node == nullptr) return 0;
  if (!node->is_array_of_tables()) {
    parsed_->keep(node, key, "must be a list of tables, each begun by [[" + std::string(key) + "]]");
    return 0;
  }
  return node->as_array()->size();
}

void ConfigFile::counts(std::string_view key, std::vector<std::size_t>& values) {
  parsed_->read_values(key, "must be a list of whole numbers of 0 or more", values, whole_number<std::size_t>);
}

void ConfigFile::texts(std::string_view key, std::vector<std::string>& values) {
  parsed_->read_values(key, "must be a list of texts in quotes", values, text_of);
}

void ConfigFile::ranges(std::string_view key, std::vector<std::pair<double, double>>& values) {
  const toml::node* node = parsed_->ask(key);
  if (node == nullptr) return;
  if (const auto number = finite_number(*node)) return values.assign(1, {*number, *number});
  parsed_->read_list_of(*node, key, "must be a number, or a list of numbers and ranges, as [-1, [4090, 4095]]", values,
                        range_of);
}

void ConfigFile::text_rows(std::string_view key, std::vector<std::vector<std::string>>& rows) {
  const toml::node* node = parsed_->ask(key);
  const toml::array* list = node != nullptr ? node->as_array() : nullptr;
  const bool is_flat = list == nullptr || list->empty() || !list->front().is_array();
  if (is_flat) return texts(key, rows.emplace_back());
  for (const toml::node& row : *list) {
    parsed_->read_list_of(row, key, "must be a list of texts in quotes, or of such lists", rows.emplace_back(),
                          text_of);
  }
}

void ConfigFile::choice(std::string_view key, const std::vector<std::string>& names, std::size_t& index) {
  const toml::node* node = parsed_->ask(key);
  if (node == nullptr) return;
  const auto name =
      std::find_if(names.begin(), names.end(), [&](const std::string& known) { return is_text(key, known); });
  if (name == names.end()) return parsed_->keep(node, key, "must be " + quoted_list(names));
  index = static_cast<std::size_t>(name - names.begin());
}

void ConfigFile::require(std::string_view key) {
  if (parsed_->ask(key) == nullptr) parsed_->keep(nullptr, key, "is missing; it has no default");
}

void ConfigFile::fail(std::string_view key, std::string_view message) {
  parsed_->keep(parsed_->find(key), key, message);
}

void ConfigFile::ignore(std::string_view key) {
  parsed_->known_keys.emplace(key);
}

Status ConfigFile::finish() const {
  const std::optional<Error>& error = parsed_->first_error;
  if (error && !parsed_->first_error_is_missing_key) return *error;
  std::optional<Parsed::Unknown> unknown;
  parsed_->find_unknown(parsed_->root, "", unknown);
  if (unknown) return parsed_->describe(*unknown);
  if (error) return *error;
  return Done{};
}

}  // namespace dermis::bytes::files
