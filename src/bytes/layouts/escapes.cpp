// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/escapes.hpp"

#include <algorithm>
#include <cstring>

namespace dermis::bytes::layouts {
namespace {

bool undo_slip(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& plain) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] != 0xDB) {
      plain.push_back(bytes[i]);
      continue;
    }
    if (++i == bytes.size() || (bytes[i] != 0xDC && bytes[i] != 0xDD)) return false;
    plain.push_back(bytes[i] == 0xDC ? 0xC0 : 0xDB);
  }
  return true;
}

bool undo_stuffing(const PacketLayout& layout, std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& plain) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const bool is_escaped = bytes[i] == layout.escape_byte;
    if (is_escaped && ++i == bytes.size()) return false;
    plain.push_back(is_escaped ? bytes[i] ^ layout.escape_xor : bytes[i]);
  }
  return true;
}

bool undo_substitution(const PacketLayout& layout, std::span<const std::uint8_t> bytes,
                       std::vector<std::uint8_t>& plain) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] != layout.escape_byte) {
      plain.push_back(bytes[i]);
      continue;
    }
    if (++i == bytes.size()) return false;
    const auto found = std::ranges::find(layout.substitutes, bytes[i], &Substitute::code);
    if (found == layout.substitutes.end()) return false;
    plain.push_back(found->byte);
  }
  return true;
}

constexpr std::size_t kMostInBlock = 254;
constexpr std::size_t kShortBlock = 8;  ///< Bytes that are copied at once, also where fewer are meant.

}  // namespace

/// A code of n stands before n - 1 bytes and, but for 255, a byte of 0. Cheshire, Baker, "Consistent Overhead Byte
/// Stuffing", IEEE/ACM Transactions on Networking 7 (1999).
std::optional<std::size_t> undo_cobs(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& plain) {
  if (plain.size() < bytes.size() + kShortBlock) plain.resize(2 * (bytes.size() + kShortBlock));
  std::uint8_t* to = plain.data();
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t block = bytes[at] - std::size_t{1};  // beyond all for a code of 0
    const std::size_t rest = bytes.size() - at - 1;
    if (block > rest) return std::nullopt;
    const std::uint8_t* const from = bytes.data() + at + 1;
    if (block <= kShortBlock && rest >= kShortBlock) {
      std::memcpy(to, from, kShortBlock);
    } else {
      std::memcpy(to, from, block);
    }
    at += block + 1;
    to += block;
    if (block < kMostInBlock && at < bytes.size()) *to++ = 0;
  }
  return static_cast<std::size_t>(to - plain.data());
}

std::uint8_t delimiter_of(const PacketLayout& layout) noexcept {
  if (layout.escape == PacketLayout::Escape::slip) return 0xC0;
  const bool has_delimiter =
      layout.escape == PacketLayout::Escape::stuffed || layout.escape == PacketLayout::Escape::substituted;
  return has_delimiter ? layout.delimiter : 0;
}

bool undo_escapes(const PacketLayout& layout, std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& plain) {
  plain.clear();
  switch (layout.escape) {
    case PacketLayout::Escape::cobs: {
      const std::optional<std::size_t> size = undo_cobs(bytes, plain);
      plain.resize(size.value_or(0));
      return size.has_value();
    }
    case PacketLayout::Escape::slip: return undo_slip(bytes, plain);
    case PacketLayout::Escape::stuffed: return undo_stuffing(layout, bytes, plain);
    case PacketLayout::Escape::substituted: return undo_substitution(layout, bytes, plain);
    case PacketLayout::Escape::none: break;
  }
  plain.assign(bytes.begin(), bytes.end());
  return true;
}

}  // namespace dermis::bytes::layouts
