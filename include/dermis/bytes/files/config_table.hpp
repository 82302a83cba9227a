// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// A TOML file read by name; texts may also have the escape "\xHH" of TOML 1.1. Every key is read once. A key that was
/// not read is an error with the nearest known name. If a key is absent, reading functions leave their target
/// untouched, so defaults live only in the struct that is filled. finish() reports the first error, as "array.toml:7:
/// readout.load_ohm: must be one number or a list of 16 numbers". Not thread-safe.
class ConfigFile {
 public:
  /// Reads and parses a file of at most 1 MiB; a syntax error names its line and column.
  [[nodiscard]] static Result<ConfigFile> read(const std::string& path);
  /// The same from memory; `name` stands for the path in messages.
  [[nodiscard]] static Result<ConfigFile> parse(std::string_view text, const std::string& name);

  ConfigFile(ConfigFile&&) noexcept;
  ConfigFile& operator=(ConfigFile&&) noexcept;
  ~ConfigFile();

  /// Keys are dotted paths: "readout.load_ohm"; the tables of a list, [[array]], have an index: "array[0].name".
  [[nodiscard]] bool contains(std::string_view key) const;
  /// True if the key holds exactly this text, for keys that take a number or a word.
  [[nodiscard]] bool is_text(std::string_view key, std::string_view text);
  /// True if the key holds any text, for keys that take a list or the name of a file.
  [[nodiscard]] bool holds_text(std::string_view key);
  void number(std::string_view key, double& value);  ///< A finite number, as everywhere below.
  void number(std::string_view key, std::optional<double>& value);
  void integer(std::string_view key, int& value);
  void count(std::string_view key, std::size_t& value);  ///< An integer of 0 or more.
  void boolean(std::string_view key, bool& value);
  void text(std::string_view key, std::string& value);
  /// One number for all, or a list of exactly `size` numbers.
  void number_per_line(std::string_view key, std::size_t size, std::vector<double>& values);
  /// A word in place of a number.
  struct Word {
    std::string text;
    double number = 0.0;
  };
  /// The same, where each number may be the word instead.
  void number_per_line(std::string_view key, std::size_t size, const Word& word, std::vector<double>& values);
  /// A list of exactly `size` numbers.
  void numbers(std::string_view key, std::size_t size, std::vector<double>& values);
  /// A list of any size of lists of exactly `size` numbers.
  void number_rows(std::string_view key, std::size_t size, std::vector<std::vector<double>>& rows);
  /// How many tables a list of tables has; 0 if there is none.
  [[nodiscard]] std::size_t table_count(std::string_view key);
  /// A list of any size of integers of 0 or more, or of texts.
  void counts(std::string_view key, std::vector<std::size_t>& values);
  void texts(std::string_view key, std::vector<std::string>& values);
  /// A number, or a list of numbers and of lists of two, [from, to]. A number is a range of its own.
  void ranges(std::string_view key, std::vector<std::pair<double, double>>& values);
  /// A list of texts, or a list of such lists.
  void text_rows(std::string_view key, std::vector<std::vector<std::string>>& rows);
  /// One of `names`; `index` is set to its place.
  void choice(std::string_view key, const std::vector<std::string>& names, std::size_t& index);
  /// Others read the value of the key.
  void ignore(std::string_view key);
  /// The key must be present.
  void require(std::string_view key);
  /// Records an error at the line of `key` (or of the file, if it is absent), unless there is one already.
  void fail(std::string_view key, std::string_view message);

  /// The first error, or a key that no function has read. An unknown key is reported before a missing one, because it
  /// is usually the missing key misspelt.
  [[nodiscard]] Status finish() const;

 private:
  ConfigFile();
  struct Parsed;
  std::unique_ptr<Parsed> parsed_;
};

}  // namespace dermis::bytes::files
