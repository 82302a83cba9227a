// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/file_kind.hpp"

#include <algorithm>
#include <array>

#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

struct Kind {
  std::string_view beginning;
  std::string_view name;
};

constexpr std::array kKinds = {
    Kind{"\x89MCAP", kMcapKind},        Kind{"\x89HDF", kHdf5Kind},       Kind{"\x93NUMPY", kNpyKind},
    Kind{"PK\x03\x04", kZipKind},       Kind{"\x89PNG", "a PNG picture"}, Kind{"BZh", "packed by bzip2"},
    Kind{"\x1f\x8b", "packed by gzip"}, Kind{"<?xml", "an XML file"},     Kind{"\x80\x02", kPickleKind},
    Kind{"\x80\x03", kPickleKind},      Kind{"\x80\x04", kPickleKind},    Kind{"\x80\x05", kPickleKind}};

/// Eight bytes of a length, of which the last are 0 in every file that can be read, and an object of JSON.
bool is_safetensors(std::string_view bytes) {
  constexpr std::size_t kLengthBytes = 8;
  return bytes.size() > kLengthBytes && bytes[kLengthBytes] == '{' &&
         bytes.substr(4, 4) == std::string_view("\0\0\0\0", 4);
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_text(std::string_view line) {
  return std::all_of(line.begin(), line.end(),
                     [](char c) { return static_cast<unsigned char>(c) >= 0x20U || is_blank(c); });
}

/// The first line that is neither empty nor a comment.
std::string_view first_line(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    if (!line.empty() && !line.starts_with('#')) return line;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return {};
}

std::string_view kind_of_text(std::string_view line) {
  if (line.empty() || !is_text(line)) return {};
  const std::size_t name = line.find_first_not_of('[');
  const bool is_named = name != std::string_view::npos && is_letter(line[name]);
  if (name > 0 && is_named && line.ends_with(']')) return kTomlKind;
  const bool is_list = line.find_first_of("=[{") == std::string_view::npos && line.find(',') != std::string_view::npos;
  return is_list ? kTableKind : std::string_view();
}

}  // namespace

std::string_view kind_of(std::string_view first_bytes) {
  const auto* const known = std::find_if(kKinds.begin(), kKinds.end(),
                                         [&](const Kind& kind) { return first_bytes.starts_with(kind.beginning); });
  if (known != kKinds.end()) return known->name;
  if (is_safetensors(first_bytes)) return kSafetensorsKind;
  return kind_of_text(first_line(first_bytes));
}

std::optional<std::string> wrong_kind(std::string_view first_bytes, std::string_view wanted) {
  const std::string_view kind = kind_of(first_bytes);
  if (kind.empty() || kind == wanted) return std::nullopt;
  return "is " + std::string(kind) + ", not " + std::string(wanted);
}

}  // namespace dermis::bytes::files
