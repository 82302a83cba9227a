// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/files/content_hash.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "dermis/files/input.hpp"

namespace dermis::files {

Result<std::string> content_hash(const std::string& path) {
  constexpr std::size_t kPieceBytes = std::size_t{1} << 20U;
  const Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  std::vector<char> piece(kPieceBytes);
  while (!(*in)->eof()) {
    (*in)->read(piece.data(), static_cast<std::streamsize>(piece.size()));
    if ((*in)->bad()) return read_failure(path);
    for (std::streamsize i = 0; i < (*in)->gcount(); ++i) {
      hash ^= static_cast<unsigned char>(piece[static_cast<std::size_t>(i)]);
      hash *= 0x100000001B3ULL;
    }
  }
  return fmt::format("fnv1a64:{:016x}", hash);
}

}  // namespace dermis::files
