// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dermis/bytes/recordings/mcap.hpp"

struct LZ4F_dctx_s;
struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace dermis::bytes::recordings {

/// Whether this build can; that of a page has not all libraries.
[[nodiscard]] bool can_compress(McapCompression compression) noexcept;
[[nodiscard]] bool can_decompress(McapCompression compression) noexcept;

/// Compresses chunks. Reuses its memory.
class Compressor {
 public:
  static constexpr int kFast = 1;

  explicit Compressor(McapCompression compression, int zstd_level = kFast);
  ~Compressor();
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  /// Appends the compressed bytes.
  void append(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out);

 private:
  McapCompression compression_;
  int zstd_level_;
  ZSTD_CCtx_s* zstd_ = nullptr;
};

/// Decompresses chunks, which may hold anything. Reuses its memory.
class Decompressor {
 public:
  Decompressor() = default;
  ~Decompressor();
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  /// Exactly `size` bytes, valid until the next call; empty where the bytes do not decompress to that. Memory grows
  /// with what is decompressed, not with what `size` says.
  [[nodiscard]] std::span<const std::uint8_t> decompress(McapCompression compression,
                                                         std::span<const std::uint8_t> bytes, std::size_t size);

 private:
  struct Step;
  [[nodiscard]] Step lz4_step(std::span<const std::uint8_t> in, std::span<std::uint8_t> out);
  [[nodiscard]] Step zstd_step(std::span<const std::uint8_t> in, std::span<std::uint8_t> out);

  LZ4F_dctx_s* lz4_ = nullptr;
  ZSTD_DCtx_s* zstd_ = nullptr;
  std::vector<std::uint8_t> out_;
};

}  // namespace dermis::bytes::recordings
