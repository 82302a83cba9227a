// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/formats/text_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 16U;
constexpr std::size_t kMaxLineBytes = std::size_t{1} << 25U;

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
  std::erase_if(text, [](char c) { return files::is_blank(c) || c == '^' || c == '-'; });
  return files::in_lower_case(text);
}

}  // namespace

TextLines::TextLines(std::unique_ptr<std::istream> in, std::string name)
    : in_(std::move(in)), name_(std::move(name)), piece_(kPieceBytes) {}

/// Takes the bytes that have come already, at least one; false at the end.
bool TextLines::fill() {
  if (in_->peek() == std::istream::traits_type::eof()) return false;
  const std::streamsize size = in_->readsome(piece_.data(), static_cast<std::streamsize>(piece_.size()));
  rest_ = {piece_.data(), static_cast<std::size_t>(size)};
  return size > 0;
}

Result<bool> TextLines::next(std::string_view& line) {
  line_.clear();
  if (rest_.empty() && !fill()) {
    if (in_->bad()) return files::read_failure(name_);
    return false;
  }
  ++number_;
  was_cut_ = true;
  while (was_cut_ && (!rest_.empty() || fill())) {
    const std::string_view part = rest_.substr(0, rest_.find('\n'));
    if (line_.size() + part.size() > kMaxLineBytes) return error("is longer than 32 MiB");
    line_ += part;
    was_cut_ = part.size() == rest_.size();
    rest_.remove_prefix(part.size() + (was_cut_ ? 0 : 1));
  }
  if (in_->bad()) return files::read_failure(name_);
  if (number_ == 1 && (line_.starts_with("\xFF\xFE") || line_.starts_with("\xFE\xFF"))) {
    return error("is UTF-16 text; save it as UTF-8");
  }
  if (number_ == 1 && line_.starts_with(files::kByteOrderMark)) line_.erase(0, files::kByteOrderMark.size());
  if (line_.ends_with('\r')) line_.pop_back();
  line = line_;
  return true;
}

Status TextLines::rewind() {
  in_->clear();
  in_->seekg(0);
  if (!in_->good()) return bad_input(name_ + ": cannot be read from a pipe; save it as a file");
  rest_ = {};
  number_ = 0;
  was_cut_ = false;
  return Done{};
}

std::string TextLines::place() const {
  return name_ + ":" + std::to_string(std::max<std::size_t>(number_, 1));
}

Error TextLines::error(const std::string& message) const {
  return bad_input(place() + ": " + message);
}

Cells::Cells(std::string_view line, Separator separator) noexcept
    : rest_(line), separator_(','), blanks_separate_(separator == Separator::any), at_end_(false) {
  const auto has = [text = files::trimmed(line)](char c) { return text.find(c) != std::string_view::npos; };
  if (blanks_separate_ && has('\t')) separator_ = '\t';
  if (blanks_separate_ && has(';')) separator_ = ';';
  skip_blanks();
  at_end_ = rest_.empty();
}

bool Cells::ends_cell(char c) const noexcept {
  return c == separator_ || (blanks_separate_ && files::is_blank(c));
}

/// At both ends of the rest.
void Cells::skip_blanks() noexcept {
  const auto is_skipped = [this](char c) { return files::is_blank(c) && c != separator_; };
  while (!rest_.empty() && is_skipped(rest_.front())) rest_.remove_prefix(1);
  while (!rest_.empty() && is_skipped(rest_.back())) rest_.remove_suffix(1);
}

bool Cells::next(std::string_view& cell) noexcept {
  if (at_end_) return false;
  std::size_t end = 0;
  for (bool is_quoted = false; end < rest_.size() && (is_quoted || !ends_cell(rest_[end])); ++end) {
    if (rest_[end] == '"') is_quoted = !is_quoted;
  }
  cell = files::trimmed(rest_.substr(0, end));
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
    cell = files::trimmed(cell.substr(1, cell.size() - 2));
  at_end_ = end == rest_.size();
  rest_.remove_prefix(end);
  skip_blanks();
  if (rest_.empty() || rest_.front() != separator_) return true;
  rest_.remove_prefix(1);
  skip_blanks();
  return true;
}

bool Cells::next_filled(std::string_view& cell) noexcept {
  while (next(cell)) {
    if (!cell.empty()) return true;
  }
  return false;
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

std::string known_units() {
  std::string names;
  for (const Unit& unit : kUnits) names.append(names.empty() ? "" : ", ").append(unit.name);
  return names;
}

}  // namespace dermis::bytes::formats
