// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/formats/zlib_input.hpp"

#include <algorithm>
#include <array>

namespace dermis::bytes::formats {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 16U;

}  // namespace

ZlibInput::ZlibInput(std::istream& in, std::uint64_t bytes, bool is_compressed)
    : in_(in), left_(bytes), is_compressed_(is_compressed) {
  if (!is_compressed_) return;
  piece_.resize(kPieceBytes);
  is_compressed_ = inflateInit(&state_) == Z_OK;
  if (!is_compressed_) left_ = 0;
}

ZlibInput::~ZlibInput() {
  if (is_compressed_) inflateEnd(&state_);
}

/// Compressed bytes; false at the end.
bool ZlibInput::fill() {
  in_.read(piece_.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(piece_.size(), left_)));
  left_ -= static_cast<std::uint64_t>(in_.gcount());
  state_.next_in = reinterpret_cast<Bytef*>(piece_.data());
  state_.avail_in = static_cast<uInt>(in_.gcount());
  return state_.avail_in > 0;
}

bool ZlibInput::read(std::span<char> into) {
  if (!is_compressed_) {
    if (into.size() > left_) return false;
    left_ -= into.size();
    return static_cast<bool>(in_.read(into.data(), static_cast<std::streamsize>(into.size())));
  }
  state_.next_out = reinterpret_cast<Bytef*>(into.data());
  state_.avail_out = static_cast<uInt>(into.size());
  while (state_.avail_out > 0) {
    if (state_.avail_in == 0 && !fill()) return false;
    const int result = inflate(&state_, Z_NO_FLUSH);
    has_ended_ = result == Z_STREAM_END;
    if (result != Z_OK && !(has_ended_ && state_.avail_out == 0)) return false;
  }
  return true;
}

bool ZlibInput::finish() {
  std::array<char, 4096> passed{};
  while (is_compressed_ && !has_ended_) {
    if (!read(passed) && !has_ended_) return false;
  }
  return true;
}

bool ZlibInput::skip(std::uint64_t bytes) {
  std::array<char, 4096> passed{};
  while (bytes > 0) {
    const std::size_t size = std::min<std::uint64_t>(bytes, passed.size());
    if (!read(std::span(passed).first(size))) return false;
    bytes -= size;
  }
  return true;
}

}  // namespace dermis::bytes::formats
