// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace dermis::report {

/// A picture of 8 bits a component.
struct Pixels {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint8_t> rgb;  ///< [height, width, 3], from the top left.
};

/// The bytes of a PNG file. 1 ... 2^24 pixels.
[[nodiscard]] std::string png(const Pixels& pixels);

/// An animated PNG that plays for ever; programs that know no animation show its first picture.
class AnimatedPng {
 public:
  /// All pictures have the size of the first; `milliseconds`: how long it is shown, 1 ... 65535.
  void add(const Pixels& pixels, unsigned milliseconds);
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// The bytes of the file; at least one picture was added.
  [[nodiscard]] std::string take() &&;

 private:
  std::size_t width_ = 0;
  std::size_t height_ = 0;
  std::uint32_t count_ = 0;
  std::uint32_t sequence_ = 0;
  std::string pictures_;  ///< Their chunks.
};

}  // namespace dermis::report
