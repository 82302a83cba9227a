// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Chunks of recordings as they are: there is no library for the page that compresses them.
#include "bytes/recordings/compression.hpp"

namespace dermis::bytes::recordings {

bool is_available(McapCompression compression) noexcept {
  return compression == McapCompression::none;
}

Compressor::Compressor(McapCompression compression, int zstd_level)
    : compression_(compression), zstd_level_(zstd_level) {}

Compressor::~Compressor() = default;

void Compressor::append(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

Decompressor::~Decompressor() = default;

std::span<const std::uint8_t> Decompressor::decompress(McapCompression compression, std::span<const std::uint8_t> bytes,
                                                       std::size_t size) {
  const bool is_whole = compression == McapCompression::none && bytes.size() == size;
  return is_whole ? bytes : std::span<const std::uint8_t>{};
}

}  // namespace dermis::bytes::recordings
