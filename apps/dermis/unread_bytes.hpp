// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace dermis::app {

/// "The bytes look like 60 lines of 81 numbers: rows=9, cols=9?"; empty where no layout reads them.
[[nodiscard]] std::string look_of_unread(std::span<const std::uint8_t> bytes);

/// The same of a file that nobody has described, and what shows more; empty of recordings, models and the like.
[[nodiscard]] std::string look_of_unread_file(const std::string& path);

/// "; 'dermis describe SOURCE' shows more"
[[nodiscard]] std::string more_by_describe(const std::string& source);

/// The first bytes of a device.
class FirstBytes {
 public:
  void add(std::span<const std::uint8_t> bytes);
  [[nodiscard]] std::span<const std::uint8_t> bytes() const noexcept { return bytes_; }

 private:
  static constexpr std::size_t kMost = 65536;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace dermis::app
