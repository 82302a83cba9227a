// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/content_hash.hpp"

#include <fmt/format.h>

#include <vector>

#include "dermis/bytes/files/input.hpp"

namespace dermis::bytes::files {

void ContentHash::add(std::string_view bytes) noexcept {
  for (const char byte : bytes) {
    hash_ ^= static_cast<unsigned char>(byte);
    hash_ *= 0x100000001B3ULL;
  }
}

std::string ContentHash::text() const {
  return fmt::format("fnv1a64:{:016x}", hash_);
}

Result<std::string> content_hash(const std::string& path) {
  constexpr std::size_t kPieceBytes = std::size_t{1} << 20U;
  const Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  ContentHash hash;
  std::vector<char> piece(kPieceBytes);
  while (!(*in)->eof()) {
    (*in)->read(piece.data(), static_cast<std::streamsize>(piece.size()));
    if ((*in)->bad()) return read_failure(path);
    hash.add({piece.data(), static_cast<std::size_t>((*in)->gcount())});
  }
  return hash.text();
}

}  // namespace dermis::bytes::files
