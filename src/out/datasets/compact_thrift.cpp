// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/compact_thrift.hpp"

namespace dermis::out::datasets {
namespace {

constexpr unsigned kHighNibble = 4;
constexpr std::size_t kLongList = 15;
constexpr unsigned kBitsOfByte = 7;
constexpr std::uint64_t kMoreFollows = 0x80;

}  // namespace

void CompactThrift::put(std::uint64_t varint) {
  while (varint >= kMoreFollows) {
    bytes_.push_back(static_cast<char>(varint | kMoreFollows));
    varint >>= kBitsOfByte;
  }
  bytes_.push_back(static_cast<char>(varint));
}

/// Zigzag: small numbers of either sign are short.
void CompactThrift::put_signed(std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  put((bits << 1U) ^ (value < 0 ? ~std::uint64_t{0} : 0));
}

void CompactThrift::put_text(std::string_view text) {
  put(text.size());
  bytes_ += text;
}

void CompactThrift::header(std::int16_t number, Type type) {
  const int step = number - last_field_.back();
  bytes_.push_back(static_cast<char>((static_cast<unsigned>(step) << kHighNibble) | static_cast<unsigned>(type)));
  last_field_.back() = number;
}

void CompactThrift::field(std::int16_t number, std::int32_t value) {
  header(number, Type::i32);
  put_signed(value);
}

void CompactThrift::field(std::int16_t number, std::int64_t value) {
  header(number, Type::i64);
  put_signed(value);
}

void CompactThrift::field(std::int16_t number, std::string_view text) {
  header(number, Type::text);
  put_text(text);
}

void CompactThrift::begin_structure(std::int16_t number) {
  header(number, Type::structure);
  begin_element();
}

void CompactThrift::begin_element() {
  last_field_.push_back(0);
}

void CompactThrift::end_structure() {
  bytes_.push_back('\0');
  last_field_.pop_back();
}

void CompactThrift::begin_list(std::int16_t number, Type type, std::size_t size) {
  header(number, Type::list);
  const std::size_t nibble = size < kLongList ? size : kLongList;
  bytes_.push_back(static_cast<char>((nibble << kHighNibble) | static_cast<std::size_t>(type)));
  if (nibble == kLongList) put(size);
}

void CompactThrift::element(std::int32_t value) {
  put_signed(value);
}

void CompactThrift::element(std::string_view text) {
  put_text(text);
}

}  // namespace dermis::out::datasets
