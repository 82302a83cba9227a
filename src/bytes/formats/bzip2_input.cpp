// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/formats/bzip2_input.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 16U;

}  // namespace

Bzip2Input::Bzip2Input(std::istream& in) : in_(in), compressed_(kBufferBytes) {
  is_compressed_ = in_.peek() == 'B';
}

Bzip2Input::~Bzip2Input() {
  end();
}

void Bzip2Input::begin() {
  is_open_ = BZ2_bzDecompressInit(&state_, 0, 0) == BZ_OK;
  is_damaged_ = !is_open_;
}

void Bzip2Input::end() {
  if (is_open_) BZ2_bzDecompressEnd(&state_);
  is_open_ = false;
}

bool Bzip2Input::rewind() {
  end();
  state_ = {};
  is_damaged_ = false;
  in_.clear();
  in_.seekg(0);
  return in_.good();
}

/// Compressed bytes; false at the end of the stream.
bool Bzip2Input::fill() {
  in_.read(compressed_.data(), static_cast<std::streamsize>(compressed_.size()));
  state_.next_in = compressed_.data();
  state_.avail_in = static_cast<unsigned>(in_.gcount());
  return state_.avail_in > 0;
}

std::size_t Bzip2Input::read(std::span<char> into) {
  if (!is_compressed_) {
    in_.read(into.data(), static_cast<std::streamsize>(into.size()));
    return static_cast<std::size_t>(in_.gcount());
  }
  state_.next_out = into.data();
  state_.avail_out = static_cast<unsigned>(into.size());
  while (state_.avail_out > 0 && !is_damaged_) {
    if (state_.avail_in == 0 && !fill()) break;
    if (!is_open_) begin();
    if (!is_open_) break;
    const int result = BZ2_bzDecompress(&state_);
    if (result == BZ_STREAM_END) {
      end();  // another may follow
    } else if (result != BZ_OK) {
      is_damaged_ = true;
    }
  }
  return into.size() - state_.avail_out;
}

}  // namespace dermis::bytes::formats
