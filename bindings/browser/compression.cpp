// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Compression of recordings in a page, which has neither lz4 nor zstd: chunks are written as they are. Those with lz4
// are read, as the command writes them so (LZ4 frame format 1.6.1, LZ4 block format).
#include "bytes/recordings/compression.hpp"

#include <algorithm>

#include "bytes/recordings/mcap_bytes.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr std::uint32_t kMagic = 0x184D2204U;
constexpr std::uint32_t kIsPlain = 0x80000000U;
constexpr unsigned kLongest = 15;  // of a length in a token; more follows it
constexpr std::size_t kShortestMatch = 4;

/// A frame of LZ4, which may hold anything, behind what is in `out` already.
class Lz4Frame {
 public:
  /// At most `size` bytes are made.
  Lz4Frame(ByteReader& in, Bytes& out, std::size_t size) : in_(in), out_(out), size_(size), begin_(out.size()) {}

  [[nodiscard]] bool decode() {
    if (in_.number<std::uint32_t>() != kMagic) return false;
    const auto flags = in_.number<std::uint8_t>();
    const auto has = [&](unsigned bit) { return (flags >> bit & 1U) != 0; };
    if (flags >> 6U != 1) return false;
    const std::size_t descriptor = 1 + (has(3) ? 8U : 0U) + (has(0) ? 4U : 0U) + 1;
    static_cast<void>(in_.consume(descriptor));
    while (const auto block = in_.number<std::uint32_t>()) {
      if (!in_.good() || !decode_block(in_.consume(block & ~kIsPlain), (block & kIsPlain) != 0)) return false;
      if (has(4)) static_cast<void>(in_.number<std::uint32_t>());
    }
    if (has(2)) static_cast<void>(in_.number<std::uint32_t>());
    return in_.good();
  }

 private:
  [[nodiscard]] bool decode_block(ByteView block, bool is_plain) {
    if (is_plain) return copy(block);
    ByteReader in(block);
    while (!in.rest().empty()) {
      const auto token = in.number<std::uint8_t>();
      const ByteView literals = in.consume(length(in, token >> 4U));
      if (!in.good() || !copy(literals)) return false;
      if (in.rest().empty()) return true;  // the last one has no match
      const auto offset = in.number<std::uint16_t>();
      const std::size_t matched = length(in, token & kLongest) + kShortestMatch;
      if (!in.good() || !repeat(offset, matched)) return false;
    }
    return true;
  }

  [[nodiscard]] static std::size_t length(ByteReader& in, unsigned first) {
    std::size_t sum = first;
    for (unsigned more = first == kLongest ? 255 : 0; more == 255 && in.good(); sum += more) {
      more = in.number<std::uint8_t>();
    }
    return sum;
  }

  [[nodiscard]] bool copy(ByteView bytes) {
    if (bytes.size() > size_ - out_.size()) return false;
    append_bytes(out_, bytes);
    return true;
  }

  /// Bytes of the frame again, which may reach into themselves.
  [[nodiscard]] bool repeat(std::size_t offset, std::size_t count) {
    if (offset == 0 || offset > out_.size() - begin_ || count > size_ - out_.size()) return false;
    const std::size_t from = out_.size() - offset;
    out_.resize(out_.size() + count);
    std::uint8_t* const to = out_.data() + from + offset;
    for (std::size_t k = 0; k < count; ++k) to[k] = out_[from + k];
    return true;
  }

  ByteReader& in_;
  Bytes& out_;
  std::size_t size_;
  std::size_t begin_;
};

}  // namespace

bool can_compress(McapCompression compression) noexcept {
  return compression == McapCompression::none;
}

bool can_decompress(McapCompression compression) noexcept {
  return compression != McapCompression::zstd;
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
  if (compression == McapCompression::none) return bytes.size() == size ? bytes : std::span<const std::uint8_t>{};
  out_.clear();
  ByteReader in(bytes);
  while (!in.rest().empty()) {
    if (!Lz4Frame(in, out_, size).decode()) return {};
  }
  return out_.size() == size ? std::span<const std::uint8_t>(out_) : std::span<const std::uint8_t>{};
}

}  // namespace dermis::bytes::recordings
