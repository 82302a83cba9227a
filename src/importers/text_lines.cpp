// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "importers/text_lines.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include "dermis/files/input.hpp"
#include "dermis/files/text.hpp"

namespace dermis::importers {
namespace {

constexpr std::size_t kMaxLineBytes = std::size_t{1} << 25U;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_blank(char c) noexcept {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f';
}

struct Unit {
  std::string_view name;  ///< Lower case, without blanks, "2" for "²".
  double factor;
};

constexpr std::array kUnits = {
    Unit{"raw", 1.0},         Unit{"kpa", 1.0},         Unit{"pa", 1e-3},        Unit{"mpa", 1e3},
    Unit{"n/mm2", 1e3},       Unit{"n/cm2", 10.0},      Unit{"bar", 100.0},      Unit{"mbar", 0.1},
    Unit{"psi", 6.894757},    Unit{"mmhg", 0.13332239}, Unit{"kg/cm2", 98.0665}, Unit{"kgf/cm2", 98.0665},
    Unit{"g/cm2", 0.0980665}, Unit{"atm", 101.325},     Unit{"n", 1.0},          Unit{"newtons", 1.0},
    Unit{"kg", 9.80665},      Unit{"g", 9.80665e-3},    Unit{"lb", 4.4482216},   Unit{"lbs", 4.4482216}};

/// As in kUnits.
std::string plain(std::string_view unit) {
  constexpr std::string_view kSquared = "²";
  std::string text(unit);
  for (std::size_t at = text.find(kSquared); at != std::string::npos; at = text.find(kSquared)) {
    text.replace(at, kSquared.size(), "2");
  }
  std::replace(text.begin(), text.end(), '\xB2', '2');  // Latin-1
  std::erase_if(text, [](char c) { return is_blank(c) || c == '^' || c == '-'; });
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  return text;
}

}  // namespace

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

TextLines::TextLines(std::unique_ptr<std::istream> in, std::string name) : in_(std::move(in)), name_(std::move(name)) {}

Result<bool> TextLines::next(std::string_view& line) {
  constexpr int kEnd = std::istream::traits_type::eof();
  line_.clear();
  std::streambuf& bytes = *in_->rdbuf();
  int byte = bytes.sbumpc();
  if (byte == kEnd) return false;
  ++number_;
  for (; byte != kEnd && byte != '\n'; byte = bytes.sbumpc()) {
    if (line_.size() == kMaxLineBytes) return error("is longer than 32 MiB");
    line_ += static_cast<char>(byte);
  }
  was_cut_ = byte == kEnd;
  if (number_ == 1 && (line_.starts_with("\xFF\xFE") || line_.starts_with("\xFE\xFF"))) {
    return error("is UTF-16 text; save it as UTF-8");
  }
  if (number_ == 1 && line_.starts_with(kByteOrderMark)) line_.erase(0, kByteOrderMark.size());
  if (line_.ends_with('\r')) line_.pop_back();
  line = line_;
  return true;
}

void TextLines::rewind() {
  in_->clear();
  in_->seekg(0);
  number_ = 0;
  was_cut_ = false;
}

std::string TextLines::place() const {
  return name_ + ":" + std::to_string(std::max<std::size_t>(number_, 1));
}

Error TextLines::error(const std::string& message) const {
  return bad_input(place() + ": " + message);
}

Cells::Cells(std::string_view line, Separator separator) noexcept
    : rest_(trimmed(line)), separator_(','), blanks_separate_(separator == Separator::any), at_end_(rest_.empty()) {
  if (blanks_separate_ && rest_.find_first_of(";\t") != std::string_view::npos) separator_ = ';';
}

bool Cells::ends_cell(char c) const noexcept {
  return c == separator_ || (blanks_separate_ && is_blank(c));
}

bool Cells::next(std::string_view& cell) noexcept {
  if (at_end_) return false;
  std::size_t end = 0;
  for (bool is_quoted = false; end < rest_.size() && (is_quoted || !ends_cell(rest_[end])); ++end) {
    if (rest_[end] == '"') is_quoted = !is_quoted;
  }
  cell = trimmed(rest_.substr(0, end));
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = trimmed(cell.substr(1, cell.size() - 2));
  at_end_ = end == rest_.size();
  rest_ = trimmed(rest_.substr(end));
  if (!rest_.empty() && rest_.front() == separator_) rest_ = trimmed(rest_.substr(1));
  return true;
}

bool parse_reading(std::string_view text, float& value) {
  if (text.empty() || text == "B" || text == "b" || text == "NaN" || text == "NAN") {
    value = std::numeric_limits<float>::quiet_NaN();
    return true;
  }
  if (text.ends_with(',')) text.remove_suffix(1);  // "1.5,<tab>2.5"
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return files::parse_number(text, value);
  std::string with_point(text);
  with_point[comma] = '.';
  return files::parse_number(with_point, value);
}

Status parse_row(std::string_view line, Cells::Separator separator, std::span<float> row) {
  Cells cells(line, separator);
  std::string_view cell;
  std::size_t count = 0;
  for (float value = 0.0F; cells.next(cell);) {
    if (count >= row.size() && cell.empty()) continue;
    if (!parse_reading(cell, value)) return bad_input(files::in_quotes(cell) + " is not a number");
    if (count < row.size()) row[count] = value;
    ++count;
  }
  if (count == row.size()) return Done{};
  return bad_input("has " + std::to_string(count) + (count == 1 ? " value" : " values") + " instead of " +
                   std::to_string(row.size()));
}

std::optional<double> factor_of_unit(std::string_view unit) {
  const std::string name = plain(unit);
  const auto* const found = std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& u) { return u.name == name; });
  if (found == kUnits.end()) return std::nullopt;
  return found->factor;
}

}  // namespace dermis::importers
