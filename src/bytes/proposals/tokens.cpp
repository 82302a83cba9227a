// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/tokens.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <string>

#include "dermis/bytes/files/numbers.hpp"

namespace dermis::bytes::proposals {
namespace {

using files::is_digit;

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_hexadecimal(char c) {
  return std::isxdigit(static_cast<unsigned char>(c)) != 0;
}

/// Bytes at the beginning that look as `picture`, in which 0 stands for a digit.
std::size_t as_pictured(std::string_view text, std::string_view picture) {
  if (text.size() < picture.size()) return 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    if (picture[i] == '0' ? !is_digit(text[i]) : text[i] != picture[i]) return 0;
  }
  return picture.size();
}

std::size_t clock_at(std::string_view text) {
  std::size_t size = std::max(as_pictured(text, "00:00:00"), as_pictured(text, "0:00:00"));
  if (size == 0 || size + 1 >= text.size() || (text[size] != '.' && text[size] != ',') || !is_digit(text[size + 1]))
    return size;
  for (++size; size < text.size() && is_digit(text[size]); ++size) {
  }
  return size;
}

std::size_t datetime_at(std::string_view text) {
  const std::size_t date = as_pictured(text, "0000-00-00");
  if (date == 0 || text.size() < date + 2 || (text[date] != ' ' && text[date] != 'T')) return 0;
  const std::size_t clock = clock_at(text.substr(date + 1));
  if (clock == 0) return 0;
  const std::size_t size = date + 1 + clock;
  const std::string_view zone = text.substr(size);
  return size + std::max({as_pictured(zone, "Z"), as_pictured(zone, "+00:00"), as_pictured(zone, "-00:00")});
}

/// Digits with a sign, a fraction and an exponent where they have them.
std::size_t decimal_at(std::string_view text, char point, char before) {
  std::size_t at = 0;
  const auto digits = [&] {
    const std::size_t from = at;
    while (at < text.size() && is_digit(text[at])) ++at;
    return at - from;
  };
  const bool may_have_sign = !is_digit(before) && !is_letter(before) && before != '.';
  if (may_have_sign && (text[0] == '-' || text[0] == '+')) ++at;
  const std::size_t whole = digits();
  std::size_t fraction = 0;
  if (at < text.size() && text[at] == point) {
    const std::size_t mark = at++;
    fraction = digits();
    if (fraction == 0 && (whole == 0 || point == ',')) at = mark;
  }
  if (whole + fraction == 0) return 0;
  if (at + 1 < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    const std::size_t mark = at++;
    if (text[at] == '-' || text[at] == '+') ++at;
    if (digits() == 0) at = mark;
  }
  return at;
}

/// A word for no reading.
std::size_t nan_at(std::string_view text, char before) {
  if (is_letter(before)) return 0;
  for (const std::string_view word : {"nan", "NaN", "NAN", "null", "None", "NA"}) {
    if (text.starts_with(word) && (text.size() == word.size() || !is_letter(text[word.size()]))) return word.size();
  }
  return 0;
}

std::size_t hexadecimal_at(std::string_view text, std::size_t width, char before) {
  if (is_letter(before) && before != 'x' && before != 'X' && width == 0) return 0;
  if (as_pictured(text, "0x") > 0 || as_pictured(text, "0X") > 0) return 0;
  std::size_t size = 0;
  while (size < text.size() && is_hexadecimal(text[size]) && (width == 0 || size < width)) ++size;
  if (width > 0) return size == width ? size : 0;
  return size > 8 || (size < text.size() && is_letter(text[size])) ? 0 : size;
}

/// "0x4F" among decimal numbers, or the checksum of "*4F" at the end of a line.
std::size_t marked_at(std::string_view text, char before) {
  const bool is_checksum = before == '*' && text.size() <= 8 && std::ranges::all_of(text, is_hexadecimal);
  if (is_checksum) return text.size();
  if (is_digit(before) || is_letter(before) || (as_pictured(text, "0x") == 0 && as_pictured(text, "0X") == 0)) return 0;
  std::size_t size = 2;
  while (size < text.size() && is_hexadecimal(text[size])) ++size;
  return size > 2 ? size : 0;
}

double value_of(std::string_view text, const Numerals& numerals) {
  std::string plain(text.starts_with('+') ? text.substr(1) : text);
  std::replace(plain.begin(), plain.end(), numerals.decimal_point, '.');
  if (numerals.is_hexadecimal) {
    unsigned whole = 0;
    return files::hexadecimal_at(plain, whole) > 0 ? whole : 0;
  }
  double value = std::numeric_limits<double>::quiet_NaN();
  return files::number_at(plain, value) > 0 ? value : std::numeric_limits<double>::quiet_NaN();
}

Token token_at(std::string_view text, const Numerals& numerals, char before) {
  if (const std::size_t size = datetime_at(text); size > 0) return {Token::Kind::datetime, text.substr(0, size)};
  if (const std::size_t size = is_digit(before) ? 0 : clock_at(text); size > 0)
    return {Token::Kind::clock, text.substr(0, size)};
  std::size_t size = 0;
  if (numerals.is_hexadecimal || numerals.width > 0) {
    size = hexadecimal_at(text, numerals.width, before);
  } else if (const std::size_t marked = marked_at(text, before); marked > 0) {
    return {Token::Kind::number, text.substr(0, marked), 0.0, true};
  } else {
    size = std::max(decimal_at(text, numerals.decimal_point, before), nan_at(text, before));
  }
  const std::string_view number = text.substr(0, size);
  return {size > 0 ? Token::Kind::number : Token::Kind::text, number, size > 0 ? value_of(number, numerals) : 0.0};
}

/// ",," between two readings holds an empty one: it becomes a number without digits.
void add_between(std::string_view text, std::vector<Token>& tokens) {
  const char sign = text.find(';') != std::string_view::npos ? ';' : ',';
  const bool is_between =
      !tokens.empty() && text.find_first_not_of(std::string(" \t[]()") + sign) == std::string_view::npos;
  for (std::size_t at = is_between ? text.find(sign) : std::string_view::npos; at != std::string_view::npos;) {
    const std::size_t next = text.find(sign, at + 1);
    if (next == std::string_view::npos) break;
    tokens.push_back({Token::Kind::text, text.substr(0, at + 1)});
    text.remove_prefix(at + 1);
    tokens.push_back({Token::Kind::number, text.substr(0, 0), std::numeric_limits<double>::quiet_NaN()});
    at = text.find(sign);
  }
  tokens.push_back({Token::Kind::text, text});
}

}  // namespace

std::vector<Token> tokens_of(std::string_view line, const Numerals& numerals) {
  std::vector<Token> tokens;
  std::size_t begin = 0;  // of the text that has not ended
  for (std::size_t at = escape_sequences_at(line); at < line.size();) {
    const Token token = token_at(line.substr(at), numerals, at > 0 ? line[at - 1] : ' ');
    if (token.kind == Token::Kind::text) {
      ++at;
      continue;
    }
    if (at > begin) add_between(line.substr(begin, at - begin), tokens);
    tokens.push_back(token);
    at += token.text.size();
    begin = at;
  }
  if (begin < line.size()) tokens.push_back({Token::Kind::text, line.substr(begin)});
  return tokens;
}

bool is_part_of_word(const std::vector<Token>& tokens, std::size_t number) {
  if (number == 0 || tokens[number].kind != Token::Kind::number) return false;
  const std::string_view before = tokens[number - 1].text;
  const bool is_escape = number == 1 && escape_sequences_at(before) == before.size();
  const bool is_hexadecimal = before.ends_with("0x") || before.ends_with("0X");
  return tokens[number - 1].kind == Token::Kind::text && !is_escape && !is_hexadecimal && !before.empty() &&
         is_letter(before.back());
}

std::size_t escape_sequences_at(std::string_view text) {
  std::size_t size = 0;
  while (text.substr(size).starts_with("\x1b[")) {
    const auto end = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(size) + 2, text.end(), is_letter);
    if (end == text.end()) break;
    size = static_cast<std::size_t>(end - text.begin()) + 1;
  }
  return size;
}

}  // namespace dermis::bytes::proposals
