// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/compression.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>

namespace dermis::bytes::recordings {
namespace {

void append_lz4(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out) {
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.blockSizeID = LZ4F_max4MB;
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentSize = bytes.size();
  const std::size_t begin = out.size();
  const std::size_t bound = LZ4F_compressFrameBound(bytes.size(), &preferences);
  out.resize(begin + bound);
  const std::size_t size = LZ4F_compressFrame(out.data() + begin, bound, bytes.data(), bytes.size(), &preferences);
  out.resize(begin + size);
}

void append_zstd(ZSTD_CCtx* context, int level, std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out) {
  const std::size_t begin = out.size();
  const std::size_t bound = ZSTD_compressBound(bytes.size());
  out.resize(begin + bound);
  const std::size_t size = ZSTD_compressCCtx(context, out.data() + begin, bound, bytes.data(), bytes.size(), level);
  out.resize(begin + size);
}

}  // namespace

Compressor::Compressor(McapCompression compression, int zstd_level)
    : compression_(compression),
      zstd_level_(zstd_level),
      zstd_(compression == McapCompression::zstd ? ZSTD_createCCtx() : nullptr) {}

Compressor::~Compressor() {
  ZSTD_freeCCtx(zstd_);
}

void Compressor::append(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out) {
  switch (compression_) {
    case McapCompression::none: out.insert(out.end(), bytes.begin(), bytes.end()); break;
    case McapCompression::lz4: append_lz4(bytes, out); break;
    case McapCompression::zstd: append_zstd(zstd_, zstd_level_, bytes, out); break;
  }
}

/// The work of one call of a library.
struct Decompressor::Step {
  std::size_t taken = 0;
  std::size_t made = 0;
  bool failed = false;
  bool ended = false;  ///< A frame of the library ended.
};

Decompressor::~Decompressor() {
  LZ4F_freeDecompressionContext(lz4_);
  ZSTD_freeDCtx(zstd_);
}

Decompressor::Step Decompressor::lz4_step(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) {
  Step step{in.size(), out.size()};
  const std::size_t result = LZ4F_decompress(lz4_, out.data(), &step.made, in.data(), &step.taken, nullptr);
  step.failed = LZ4F_isError(result) != 0;
  step.ended = result == 0;
  return step;
}

Decompressor::Step Decompressor::zstd_step(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) {
  ZSTD_inBuffer from{in.data(), in.size(), 0};
  ZSTD_outBuffer to{out.data(), out.size(), 0};
  const std::size_t result = ZSTD_decompressStream(zstd_, &to, &from);
  return {from.pos, to.pos, ZSTD_isError(result) != 0, result == 0};
}

std::span<const std::uint8_t> Decompressor::decompress(McapCompression compression, std::span<const std::uint8_t> bytes,
                                                       std::size_t size) {
  if (compression == McapCompression::none) return bytes.size() == size ? bytes : std::span<const std::uint8_t>{};
  const bool is_lz4 = compression == McapCompression::lz4;
  if (is_lz4 && lz4_ == nullptr && LZ4F_isError(LZ4F_createDecompressionContext(&lz4_, LZ4F_VERSION)) != 0) return {};
  if (!is_lz4 && zstd_ == nullptr) zstd_ = ZSTD_createDCtx();
  if (is_lz4) LZ4F_resetDecompressionContext(lz4_);
  if (!is_lz4) ZSTD_DCtx_reset(zstd_, ZSTD_reset_session_only);
  if (!is_lz4) ZSTD_DCtx_setParameter(zstd_, ZSTD_d_windowLogMax, 26);

  constexpr std::size_t kFirstBytes = std::size_t{1} << 20U;
  if (out_.size() < std::min(size, kFirstBytes)) out_.resize(std::min(size, kFirstBytes));
  std::size_t made = 0;
  bool ended = false;
  while (!ended || !bytes.empty()) {
    if (made == out_.size() && made < size) out_.resize(std::min(size, 2 * made));
    const std::span<std::uint8_t> room = std::span(out_).first(std::min(size, out_.size())).subspan(made);
    const Step step = is_lz4 ? lz4_step(bytes, room) : zstd_step(bytes, room);
    if (step.failed || (step.taken == 0 && step.made == 0 && !step.ended)) return {};
    bytes = bytes.subspan(step.taken);
    made += step.made;
    ended = step.ended;
  }
  return made == size ? std::span<const std::uint8_t>(out_).first(size) : std::span<const std::uint8_t>{};
}

bool can_compress(McapCompression /*compression*/) noexcept {
  return true;
}

bool can_decompress(McapCompression /*compression*/) noexcept {
  return true;
}

}  // namespace dermis::bytes::recordings
