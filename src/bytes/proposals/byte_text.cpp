// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/byte_text.hpp"

#include <algorithm>
#include <cstddef>

namespace dermis::bytes::proposals {

bool is_text(std::span<const std::uint8_t> bytes) {
  const auto count = std::count_if(bytes.begin(), bytes.end(), [](std::uint8_t byte) {
    return (byte >= 0x20 && byte < 0x7F) || byte == '\t' || byte == '\r' || byte == '\n' || byte == 0x1B;
  });
  const auto nuls = std::count(bytes.begin(), bytes.end(), 0);
  return 20 * (static_cast<std::size_t>(count) + std::min(static_cast<std::size_t>(nuls), bytes.size() / 8)) >=
         17 * bytes.size();
}

std::string printable(std::string_view text) {
  std::string result(text);
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < 0x20 || c > 0x7E; }, '?');
  return result;
}

}  // namespace dermis::bytes::proposals
