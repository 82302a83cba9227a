// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <zlib.h>

#include <cstdint>
#include <istream>
#include <span>
#include <vector>

namespace dermis::bytes::formats {

/// The next so many bytes of a stream, decompressed if they are those of zlib. The stream must outlive it. Not
/// thread-safe.
class ZlibInput {
 public:
  ZlibInput(std::istream& in, std::uint64_t bytes, bool is_compressed);
  ZlibInput(const ZlibInput&) = delete;
  ZlibInput& operator=(const ZlibInput&) = delete;
  ~ZlibInput();

  /// Fills `into`; false where the bytes end or are damaged before.
  [[nodiscard]] bool read(std::span<char> into);
  /// Passes over so many bytes; false as above.
  [[nodiscard]] bool skip(std::uint64_t bytes);
  /// Reads on to the end; false where the checksum of zlib says that something is damaged.
  [[nodiscard]] bool finish();

 private:
  bool fill();

  std::istream& in_;
  std::uint64_t left_;  // of the stream
  bool is_compressed_;
  bool has_ended_ = false;  ///< All is decompressed.
  std::vector<char> piece_;
  z_stream state_{};
};

}  // namespace dermis::bytes::formats
