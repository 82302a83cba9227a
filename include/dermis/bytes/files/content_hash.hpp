// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// FNV-1a of 64 bits. It detects accidental changes, not forgery: of a single byte always, of more all but surely.
class ContentHash {
 public:
  void add(std::string_view bytes) noexcept;
  /// The hash of all bytes so far: "fnv1a64:" and 16 hexadecimal digits.
  [[nodiscard]] std::string text() const;

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

/// The ContentHash of the bytes of a file.
[[nodiscard]] Result<std::string> content_hash(const std::string& path);

}  // namespace dermis::bytes::files
