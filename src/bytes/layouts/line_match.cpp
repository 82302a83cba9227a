// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/line_match.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include "bytes/layouts/has_role.hpp"
#include "dermis/bytes/files/numbers.hpp"

namespace dermis::bytes::layouts {
namespace {

using files::digit;

constexpr std::size_t kMostShown = 24;
constexpr double kMostNanos = 9e18;

bool is_blank(std::uint8_t byte) noexcept {
  return byte == ' ' || byte == '\t';
}

/// Blank, or a bracket of a list in a line.
bool is_passed_over(std::uint8_t byte) noexcept {
  return is_blank(byte) || byte == '[' || byte == ']' || byte == '(' || byte == ')';
}

}  // namespace

LineMatch::LineMatch(const Layout& layout, std::size_t array)
    : layout_(layout),
      text_(std::get<TextLayout>(layout.form)),
      array_(array),
      names_array_(has_role(text_.lines, Role::array)),
      has_plain_separators_(text_.separator.empty() && text_.decimal_point != ',' && text_.width == 0 &&
                            !text_.is_hexadecimal) {
  for (const TextLayout::Pattern& fields : text_.lines) patterns_.push_back(pattern_of(fields));
  std::size_t most = 0;
  for (const LayoutArray& other : layout.arrays) most = std::max(most, other.shape.taxel_count());
  numbers_.resize(most);
  others_.resize(most);
  heads_.array = array;
}

LineMatch::Pattern LineMatch::pattern_of(const TextLayout::Pattern& fields) const {
  const bool is_head = !has_role(fields, Role::values);
  const bool has_no_field = std::ranges::all_of(
      fields, [](const TextField& field) { return field.role == Role::literal || field.role == Role::skip; });
  const bool begins_frame = is_head && (has_no_field || has_role(fields, Role::frame) || has_time(fields));
  const bool is_taxel = has_role(fields, Role::col) || has_role(fields, Role::first);
  const bool is_row = has_role(fields, Role::row) || has_role(text_.lines, Role::row);
  const bool may_be_row = text_.frame_end.has_value() || !text_.frame_begin.empty() || text_.lines.size() > 1;
  const Holds holds = is_taxel ? Holds::taxel : is_row ? Holds::row : may_be_row ? Holds::row_or_frame : Holds::frame;
  std::vector<std::size_t> shares;
  for (std::size_t k = 0; k < layout_.arrays.size(); ++k) shares.push_back(shares_of(fields, k));
  return {&fields, holds, std::move(shares), is_head, begins_frame, has_role(fields, Role::temperature)};
}

bool LineMatch::read(std::span<const std::uint8_t> line, Piece& piece) {
  misfit_at_ = line.data();
  for (const Pattern& pattern : patterns_) {
    pattern_ = &pattern;
    if (!read_pattern(line, piece)) continue;
    if (pattern.is_head) {
      heads_ = piece;
      heads_.is_time_of_heads = true;
    }
    return true;
  }
  return false;
}

bool LineMatch::read_pattern(std::span<const std::uint8_t> line, Piece& piece) {
  piece = heads_;
  if (pattern_->has_temperature) piece.forget_temperatures();
  count_ = 0;
  at_ = line.data();
  end_ = line.data() + line.size();
  const TextLayout::Pattern& fields = *pattern_->fields;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const TextField* const next = k + 1 < fields.size() ? &fields[k + 1] : nullptr;
    if (!read_field(fields[k], next, piece)) return false;
  }
  skip_separator();
  return at_ == end_ || fail("the line should end");
}

std::string LineMatch::misfit() const {
  if (misfit_at_ == end_) return std::string("at its end: ") + why_;
  const std::size_t shown = std::min(kMostShown, static_cast<std::size_t>(end_ - misfit_at_));
  std::string text(misfit_at_, misfit_at_ + shown);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < 0x20 || c > 0x7E; }, '?');
  return "at '" + text + "': " + why_;
}

bool LineMatch::fail(const char* why) noexcept {
  if (at_ < misfit_at_) return false;
  misfit_at_ = at_;
  why_ = why;
  return false;
}

bool LineMatch::read_field(const TextField& field, const TextField* next, Piece& piece) {
  if (field.role == Role::literal) return read_literal(field.literal);
  if (field.role == Role::values) return read_readings(field, names_array_ ? piece.array : field.array, piece);
  skip_blanks();
  double number = 0.0;
  switch (field.role) {
    case Role::skip: return skip_to(next);
    case Role::row: return read_counted(field, piece.row);
    case Role::col: return read_counted(field, piece.col);
    case Role::first: return read_counted(field, piece.first);
    case Role::frame: return read_whole(piece.frame, field);
    case Role::flags: return read_whole(piece.flags, field);
    case Role::array: return read_array(next, piece);
    case Role::clock: piece.set_time(0, 1.0); return read_clock(*piece.time_ns);
    case Role::datetime: piece.set_time(0, 1.0); return read_datetime(*piece.time_ns);
    default: break;
  }
  if (!read_number_of(field, number)) return fail("a number is expected");
  number *= field.unit;
  if (field.role == Role::temperature) piece.add_temperature(number);
  if (field.role == Role::supply && number > 0.0) piece.supply_v = number;
  if (field.role != Role::time) return true;
  const double nanos = std::round(1e9 * number);
  if (!(nanos >= 0.0 && nanos < kMostNanos)) return fail("a time of 0 or more is expected");
  piece.set_time(static_cast<std::uint64_t>(nanos), field.unit);
  return true;
}

bool LineMatch::read_literal(const std::string& literal) noexcept {
  if (!is_passed_over(static_cast<std::uint8_t>(literal.front()))) {
    while (at_ != end_ && is_passed_over(*at_)) ++at_;
  }
  for (const char c : literal) {
    const auto byte = static_cast<std::uint8_t>(c);
    if (is_blank(byte)) {
      skip_blanks();
    } else if (at_ == end_ || *at_ != byte) {
      return fail("other text is expected");
    } else {
      ++at_;
    }
  }
  return true;
}

bool LineMatch::skip_to(const TextField* next) noexcept {
  if (next == nullptr) {
    at_ = end_;
    return true;
  }
  const std::string_view first(next->literal.data(), next->literal.size());
  const auto* const found = std::search(at_, end_, first.begin(), first.end(), [](std::uint8_t a, char b) {
    return a == static_cast<std::uint8_t>(b) || (is_blank(a) && is_blank(static_cast<std::uint8_t>(b)));
  });
  at_ = found;
  return found != end_ || fail("more is expected");
}

bool LineMatch::read_readings(const TextField& field, std::size_t array, Piece& piece) {
  const FrameShape& shape = layout_.arrays[array].shape;
  const std::size_t shares = std::max<std::size_t>(pattern_->shares[names_array_ ? 0 : array], 1);
  const Holds holds = pattern_->holds;
  const bool may_be_row = holds == Holds::row || (holds == Holds::row_or_frame && shares == 1);
  const std::size_t usual = holds == Holds::taxel ? 1 : (may_be_row ? shape.cols : shape.taxel_count()) / shares;
  const std::size_t least = field.count > 0 ? field.count : usual;
  const std::size_t most = field.count == 0 && holds == Holds::row_or_frame ? shape.taxel_count() / shares : least;
  const std::span<float> values = array == array_ ? std::span(numbers_).subspan(count_) : std::span(others_);
  if (values.size() < most) return fail("more readings than the array has");
  if (!read_values(values, 0, least)) return false;
  const std::uint8_t* const row_end = at_;
  const bool is_frame = least == most || read_values(values, least, most);
  if (!is_frame) at_ = row_end;
  if (array == array_) count_ += is_frame ? most : least;
  if (!names_array_) piece.array = count_ > 0 ? array_ : array;
  return true;
}

bool LineMatch::read_values(std::span<float> values, std::size_t from, std::size_t to) noexcept {
  for (std::size_t i = from; i < to; ++i) {
    if (i == 0 || text_.width > 0) {
      while (at_ != end_ && is_passed_over(*at_)) ++at_;
    } else if (!skip_separator()) {
      return fail(at_ == end_ ? "more readings are expected" : "a separator is expected");
    }
    if (!read_reading(values[i])) return fail("a reading is expected");
    if (has_plain_separators_) i += read_plain(values.subspan(i + 1, to - i - 1));
  }
  return true;
}

/// Reads whole numbers behind one blank or comma each, as most lines have them. Returns how many there are before
/// anything else.
std::size_t LineMatch::read_plain(std::span<float> values) noexcept {
  constexpr std::ptrdiff_t kMostDigits = 9;
  const std::uint8_t* at = at_;
  std::size_t count = 0;
  for (; count < values.size() && at != end_ && (*at == ' ' || *at == ','); ++count) {
    const std::uint8_t* const first = ++at;
    const std::uint32_t whole = files::take_digits(at);
    const bool is_whole = at != first && at - first <= kMostDigits && *at != '.' && (*at | 0x20U) != 'e';
    if (!is_whole) break;
    values[count] = static_cast<float>(whole);
    at_ = at;
  }
  return count;
}

/// A reading, or NaN for an empty one and for nan.
bool LineMatch::read_reading(float& value) noexcept {
  if (text_.width > 0 || text_.is_hexadecimal) return read_digits(value);
  const std::uint8_t* const first = at_;
  const std::uint32_t whole = files::take_digits(at_);
  const bool is_whole = at_ != first && at_ - first <= 9 && *at_ != static_cast<std::uint8_t>(text_.decimal_point) &&
                        (*at_ | 0x20U) != 'e';
  if (is_whole) {
    value = static_cast<float>(whole);
    return true;
  }
  at_ = first;
  double number = 0.0;
  if (read_number(number)) {
    value = static_cast<float>(number);
    return true;
  }
  const bool is_empty = at_ != end_ && (*at_ == ',' || *at_ == ';');
  value = std::numeric_limits<float>::quiet_NaN();
  return is_empty || skip_absent();
}

/// As many as the width says, or hexadecimal ones.
bool LineMatch::read_digits(float& value) noexcept {
  std::string_view digits = rest().substr(0, text_.width > 0 ? text_.width : std::string_view::npos);
  if (digits.size() < text_.width) return false;
  const bool has_prefix =
      text_.is_hexadecimal && digits.size() > 2 && (digits.starts_with("0x") || digits.starts_with("0X"));
  if (has_prefix) digits.remove_prefix(2);
  std::uint32_t whole = 0;
  const std::size_t size =
      text_.is_hexadecimal ? files::hexadecimal_at(digits, whole) : files::number_at(digits, whole);
  if (size == 0 || (text_.width > 0 && size < digits.size())) return false;
  at_ += size + (has_prefix ? 2 : 0);
  value = static_cast<float>(whole);
  return true;
}

/// Programs print these for no reading, beside nan.
bool LineMatch::skip_absent() noexcept {
  constexpr std::array<std::string_view, 5> kWords = {"null", "None", "N/A", "NA", "--"};
  for (const std::string_view word : kWords) {
    if (!rest().starts_with(word)) continue;
    at_ += word.size();
    return true;
  }
  return false;
}

bool LineMatch::read_whole(std::optional<std::uint64_t>& value, const TextField& field) noexcept {
  std::string_view digits = rest();
  const bool has_prefix = field.is_hexadecimal && (digits.starts_with("0x") || digits.starts_with("0X"));
  if (has_prefix) digits.remove_prefix(2);
  if (field.width > 0) digits = digits.substr(0, field.width);
  std::uint64_t whole = 0;
  const std::size_t size =
      field.is_hexadecimal ? files::hexadecimal_at(digits, whole) : files::number_at(digits, whole);
  if (size == 0 || size < field.width) return fail("a whole number is expected");
  at_ += size + (has_prefix ? 2 : 0);
  value = whole;
  return true;
}

/// One that has digits of its own is whole.
bool LineMatch::read_number_of(const TextField& field, double& number) noexcept {
  if (!field.is_hexadecimal && field.width == 0) return read_number(number);
  std::optional<std::uint64_t> whole;
  if (!read_whole(whole, field)) return false;
  number = static_cast<double>(*whole);
  return true;
}

/// Of rows, columns or taxels, which may be counted from 1 on.
bool LineMatch::read_counted(const TextField& field, std::optional<std::uint64_t>& value) noexcept {
  if (!read_whole(value, field)) return false;
  if (*value < field.from) return fail("a greater number is expected");
  *value -= field.from;
  return true;
}

bool LineMatch::read_number(double& value) noexcept {
  constexpr std::size_t kLongest = 32;
  const std::uint8_t* last = at_;
  std::array<char, kLongest> text{};
  std::size_t size = 0;
  const auto is_part = [](std::uint8_t byte) {
    return digit(byte) <= 9 || byte == '+' || byte == '-' || (byte | 0x20U) == 'e' || (byte | 0x20U) == 'n' ||
           (byte | 0x20U) == 'a';
  };
  if (last != end_ && *last == '+') ++last;
  for (; last != end_ && size < kLongest; ++last) {
    const bool is_point = *last == static_cast<std::uint8_t>(text_.decimal_point);
    if (!is_point && !is_part(*last)) break;
    text[size++] = is_point ? '.' : static_cast<char>(*last);
  }
  if (!files::parse_number(std::string_view(text.data(), size), value)) return false;
  at_ = last;
  return true;
}

/// A name or an id, up to a blank or the text that follows.
bool LineMatch::read_array(const TextField* next, Piece& piece) {
  const std::uint8_t stop = next != nullptr ? static_cast<std::uint8_t>(next->literal.front()) : 0;
  const std::uint8_t* const last =
      std::find_if(at_, end_, [&](std::uint8_t byte) { return is_blank(byte) || (next != nullptr && byte == stop); });
  const std::string name(at_, last);
  const auto found = std::find_if(layout_.arrays.begin(), layout_.arrays.end(), [&](const LayoutArray& array) {
    return array.id ? name == std::to_string(*array.id) : name == array.name;
  });
  if (found == layout_.arrays.end()) return fail("the name or id of an array is expected");
  at_ = last;
  piece.array = static_cast<std::size_t>(found - layout_.arrays.begin());
  return true;
}

void LineMatch::skip_blanks() noexcept {
  while (at_ != end_ && is_blank(*at_)) ++at_;
}

/// True where something separates two readings.
bool LineMatch::skip_separator() noexcept {
  const std::uint8_t* const first = at_;
  while (at_ != end_ && is_passed_over(*at_)) ++at_;
  if (text_.separator.empty()) {
    const bool is_sign = at_ != end_ && ((*at_ == ',' && text_.decimal_point != ',') || *at_ == ';');
    if (is_sign) ++at_;
  } else if (static_cast<std::size_t>(end_ - at_) >= text_.separator.size() &&
             std::memcmp(at_, text_.separator.data(), text_.separator.size()) == 0) {
    at_ += text_.separator.size();
  } else if (!is_blank(static_cast<std::uint8_t>(text_.separator.front()))) {
    return at_ == end_ ? false : (at_ = first, false);
  }
  const bool is_separated = at_ != first;
  while (at_ != end_ && is_passed_over(*at_)) ++at_;
  return is_separated;
}

}  // namespace dermis::bytes::layouts
