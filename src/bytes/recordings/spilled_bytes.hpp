// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "bytes/recordings/mcap_bytes.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::recordings {

/// Bytes that grow at their end: the last 64 KiB in memory, those before in a file without a name. The file is gone
/// with the process, however that ends. Not thread-safe.
class SpilledBytes {
 public:
  /// The file is opened beside `path` when it is needed.
  explicit SpilledBytes(std::string path) : path_(std::move(path)) {}
  SpilledBytes(const SpilledBytes&) = delete;
  SpilledBytes& operator=(const SpilledBytes&) = delete;
  ~SpilledBytes();

  /// Fails where the disk takes no more. The bytes are here then all the same, in memory.
  [[nodiscard]] Status append(ByteView bytes);
  [[nodiscard]] std::uint64_t size() const noexcept { return in_file_ + recent_.size(); }
  /// Forgets the bytes from `size` on.
  void cut(std::uint64_t size);
  /// Fills `bytes` with those from `place` on, which must be there.
  [[nodiscard]] Status read(std::uint64_t place, std::span<std::uint8_t> bytes) const;

 private:
  [[nodiscard]] Status spill();

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t in_file_ = 0;
  Bytes recent_;
};

}  // namespace dermis::bytes::recordings
