// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace dermis::out::websocket {

/// A file that is sent piece by piece, as long as it was when it was opened. Not thread-safe.
class FileOnItsWay {
 public:
  static constexpr std::size_t kPieceBytes = 256U << 10U;

  /// False where there is no such file that can be read, or it is no regular one.
  [[nodiscard]] bool open(const std::string& path);

  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  /// Reads the next piece; false where there is none, or the file has become shorter.
  [[nodiscard]] bool read_piece();
  [[nodiscard]] const std::vector<char>& piece() const noexcept { return piece_; }

 private:
  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::uint64_t left_ = 0;
  std::vector<char> piece_;
};

}  // namespace dermis::out::websocket
