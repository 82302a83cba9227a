// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/files/config_text.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "dermis/bytes/files/numbers.hpp"
#include "dermis/bytes/files/output_place.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20U;
constexpr std::size_t kMaxKeyDotsPerLine = 64;

bool is_decimal_point(std::string_view line, std::size_t dot) {
  std::size_t first = dot;
  while (first > 0 && is_digit(line[first - 1])) --first;
  const bool digits_around = first < dot && dot + 1 < line.size() && is_digit(line[dot + 1]);
  return digits_around && (first == 0 || line[first - 1] != '.');
}

/// toml++ bounds the nesting of values but not the parts of a dotted key, and frees its tables recursively.
bool has_too_deep_key(std::string_view line) {
  std::size_t dots = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool is_ellipsis = i > 0 && line[i - 1] == '.';
    if (line[i] == '.' && !is_ellipsis && !is_decimal_point(line, i)) ++dots;
  }
  return dots > kMaxKeyDotsPerLine;
}

/// Where the text in quotes ends that begins at `at`: behind its last quote.
std::size_t end_of_quoted(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const bool has_three = text.substr(at, 3) == std::string(3, quote);
  const std::string_view end = text.substr(at, has_three ? 3 : 1);
  for (std::size_t i = at + end.size(); i < text.size(); ++i) {
    if (text.substr(i).starts_with(end)) return i + end.size();
    if (!has_three && text[i] == '\n') return i;
    if (quote == '"' && text[i] == '\\') ++i;
  }
  return text.size();
}

std::string without_byte_escapes(std::string_view quoted) {
  std::string result;
  for (std::size_t i = 0; i < quoted.size(); ++i) {
    result += quoted[i];
    if (quoted[i] != '\\' || i + 1 == quoted.size()) continue;
    const char code = quoted[++i];
    result += code == 'x' ? "u00" : std::string(1, code);
  }
  return result;
}

}  // namespace

std::string with_byte_escapes(std::string_view text) {
  std::string result;
  if (text.find("\\x") == std::string_view::npos) return result.assign(text);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t next = std::min(text.find_first_of("\"'#", at), text.size());
    result += text.substr(at, next - at);
    if (next == text.size()) break;
    const bool is_comment = text[next] == '#';
    at = is_comment ? std::min(text.find('\n', next), text.size()) : end_of_quoted(text, next);
    const std::string_view piece = text.substr(next, at - next);
    result += text[next] == '"' ? without_byte_escapes(piece) : std::string(piece);
  }
  return result;
}

Result<std::string> read_config_text(const std::string& path) {
  if (Status readable = check_readable(path); !readable) return readable.error();
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) return bad_input("cannot open '" + path + "': " + std::strerror(errno));
  std::string text(kMaxBytes + 1, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  if (std::ferror(file.get()) != 0) return failed("cannot read '" + path + "': " + std::strerror(errno));
  return text;
}

Status check_config_text(std::string_view text, const std::string& name) {
  if (text.size() > kMaxBytes) return bad_input(name + ": is larger than 1 MiB");
  for (std::size_t line_number = 1; !text.empty(); ++line_number) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    if (has_too_deep_key(text.substr(0, length))) {
      return bad_input(name + ":" + std::to_string(line_number) + ": too many dots in one line; break it");
    }
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return Done{};
}

}  // namespace dermis::bytes::files
