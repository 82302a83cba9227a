// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <bzlib.h>

#include <istream>
#include <span>
#include <vector>

namespace dermis::bytes::formats {

/// The bytes of a stream, decompressed where it begins as a bzip2 file does. The stream must outlive it. Not
/// thread-safe.
class Bzip2Input {
 public:
  explicit Bzip2Input(std::istream& in);
  Bzip2Input(const Bzip2Input&) = delete;
  Bzip2Input& operator=(const Bzip2Input&) = delete;
  ~Bzip2Input();

  /// Fills `into`; fewer bytes at the end, where the compressed bytes are cut or damaged, or where the stream is bad.
  [[nodiscard]] std::size_t read(std::span<char> into);
  /// The bytes are no bzip2 from where read() ended.
  [[nodiscard]] bool is_damaged() const noexcept { return is_damaged_; }

  /// To the first byte again; false where the stream cannot seek.
  [[nodiscard]] bool rewind();

 private:
  void begin();
  void end();
  bool fill();

  std::istream& in_;
  std::vector<char> compressed_;
  bz_stream state_{};
  bool is_compressed_ = false;
  bool is_open_ = false;  ///< state_ is in use.
  bool is_damaged_ = false;
};

}  // namespace dermis::bytes::formats
