// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/files/npy_header.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <optional>

#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kMaxHeaderBytes = std::size_t{1} << 16U;
constexpr std::size_t kMaxDimensions = 8;
constexpr const char* kCannotBeRead = "its header cannot be read; write the file with numpy.save";

Error damaged() {
  return bad_input(kCannotBeRead);
}

/// Takes tokens of a literal of Python from the left.
class Literal {
 public:
  explicit Literal(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool consume(char c) {
    skip_blanks();
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }

  /// A text in single or double quotes, without escapes.
  [[nodiscard]] std::optional<std::string_view> text() {
    skip_blanks();
    if (rest_.empty() || (rest_[0] != '\'' && rest_[0] != '"')) return std::nullopt;
    const std::size_t end = rest_.find(rest_[0], 1);
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view inside = rest_.substr(1, end - 1);
    rest_.remove_prefix(end + 1);
    if (inside.find('\\') != std::string_view::npos) return std::nullopt;
    return inside;
  }

  [[nodiscard]] std::optional<bool> boolean() {
    skip_blanks();
    for (const bool value : {false, true}) {
      const std::string_view name = value ? "True" : "False";
      if (!rest_.starts_with(name)) continue;
      rest_.remove_prefix(name.size());
      return value;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<std::uint64_t> number() {
    skip_blanks();
    const std::size_t end = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
    std::size_t value = 0;
    if (!parse_number(rest_.substr(0, end), value)) return std::nullopt;
    rest_.remove_prefix(end);
    if (rest_.starts_with('L')) rest_.remove_prefix(1);  // written by Python 2
    return value;
  }

  [[nodiscard]] bool is_at_end() {
    skip_blanks();
    return rest_.empty();
  }

 private:
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\n\r"), rest_.size())); }

  std::string_view rest_;
};

/// (3, 4, 5), (3,) or ().
bool take_shape(Literal& literal, std::vector<std::uint64_t>& shape) {
  if (!literal.consume('(')) return false;
  shape.clear();
  while (!literal.consume(')')) {
    const std::optional<std::uint64_t> size = literal.number();
    if (!size || shape.size() == kMaxDimensions) return false;
    shape.push_back(*size);
    if (literal.consume(',')) continue;
    return shape.size() > 1 && literal.consume(')');
  }
  return true;
}

Status parse_type(std::string_view type, NpyHeader& header) {
  const bool has_order = type.size() == 3 && std::string_view("<>|=").find(type[0]) != std::string_view::npos;
  if (has_order) {
    header.kind = type[1];
    header.item_bytes = static_cast<std::size_t>(type[2] - '0');
    header.is_big_endian = type[0] == '>';
    const auto is_one_of = [&](std::initializer_list<std::size_t> sizes) {
      return std::find(sizes.begin(), sizes.end(), header.item_bytes) != sizes.end();
    };
    if ((header.kind == 'u' || header.kind == 'i') && is_one_of({1, 2, 4, 8})) return Done{};
    if (header.kind == 'f' && is_one_of({4, 8})) return Done{};
  }
  if (type.ends_with('O')) {
    return bad_input("holds objects of Python (a pickle), which may run any program when they are read; save numbers " +
                     std::string("alone, by numpy.save of a plain array"));
  }
  return bad_input("has elements of type " + in_quotes(type) +
                   "; whole numbers of 8 to 64 bits and floats of 32 or 64 bits can be read: use astype");
}

/// The length of the dictionary: two bytes in version 1.0, four from 2.0 on.
Result<std::size_t> read_length(std::istream& in) {
  std::array<char, 8> begin{};
  in.read(begin.data(), begin.size());
  if (in.gcount() != 8 || std::string_view(begin.data(), kMagic.size()) != kMagic) {
    return bad_input("is no .npy file; write it with numpy.save");
  }
  const auto version = static_cast<unsigned char>(begin[6]);
  if (version < 1 || version > 3) return bad_input("is of a version of .npy that is not known; known: 1.0 to 3.0");
  std::array<std::uint8_t, 4> bytes{};
  const std::streamsize count = version == 1 ? 2 : 4;
  in.read(reinterpret_cast<char*>(bytes.data()), count);
  if (in.gcount() != count) return damaged();
  return std::size_t{std::bit_cast<std::uint32_t>(bytes)};
}

}  // namespace

Result<NpyHeader> read_npy_header(std::istream& in) {
  const Result<std::size_t> length = read_length(in);
  if (!length) return length.error();
  if (*length > kMaxHeaderBytes) return damaged();
  std::string text(*length, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (static_cast<std::size_t>(in.gcount()) != text.size()) return damaged();
  return parse_npy_dictionary(text);
}

Result<NpyHeader> parse_npy_dictionary(std::string_view text) {
  NpyHeader header;
  Literal literal(text);
  std::string_view type;
  std::optional<bool> is_fortran_order;
  bool has_shape = false;
  if (!literal.consume('{')) return damaged();
  while (!literal.consume('}')) {
    const std::optional<std::string_view> key = literal.text();
    if (!key || !literal.consume(':')) return damaged();
    if (*key == "descr" && type.empty()) {
      const std::optional<std::string_view> value = literal.text();
      if (!value || value->empty()) return bad_input("has elements of several numbers; save the counts alone");
      type = *value;
    } else if (*key == "fortran_order" && !is_fortran_order) {
      is_fortran_order = literal.boolean();
      if (!is_fortran_order) return damaged();
    } else if (*key == "shape" && !has_shape) {
      has_shape = take_shape(literal, header.shape);
      if (!has_shape) return damaged();
    } else {
      return damaged();
    }
    if (literal.consume(',')) continue;
    if (!literal.consume('}')) return damaged();
    break;
  }
  if (!literal.is_at_end() || type.empty() || !is_fortran_order || !has_shape) return damaged();
  header.is_fortran_order = *is_fortran_order;
  if (const Status known = parse_type(type, header); !known) return known.error();
  return header;
}

std::string npy_header(std::string_view type, std::uint64_t frames, std::size_t rows, std::size_t cols) {
  constexpr std::size_t kPrefixBytes = 10;
  std::string dictionary = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (" +
                           std::to_string(frames) + ", " + std::to_string(rows) + ", " + std::to_string(cols) + "), }";
  assert(dictionary.size() < kNpyHeaderBytes - kPrefixBytes);
  dictionary.resize(kNpyHeaderBytes - kPrefixBytes - 1, ' ');
  std::string header(kMagic);
  header.append({1, 0, static_cast<char>(kNpyHeaderBytes - kPrefixBytes), 0});
  return header + dictionary + "\n";
}

}  // namespace dermis::bytes::files
