// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dermis/layouts/layout.hpp"
#include "layouts/frame_assembly.hpp"

namespace dermis::layouts {

/// Reads the lines of a layout. Keeps the readings of one array of those that a line has.
class LineMatch {
 public:
  LineMatch(const Layout& layout, std::size_t array);

  /// Reads a line without its end. The byte behind it must be there, and be no part of a number. False where the line
  /// does not fit; then misfit() says where and why.
  [[nodiscard]] bool read(std::span<const std::uint8_t> line, Piece& piece);

  [[nodiscard]] std::span<const float> numbers() const noexcept { return numbers_; }
  /// "at 'xyz': a number is expected", of the last line that did not fit.
  [[nodiscard]] std::string misfit() const;

 private:
  bool fail(const char* why) noexcept;
  bool read_field(const TextField& field, const TextField* next, Piece& piece);
  bool read_literal(const std::string& literal) noexcept;
  bool skip_to(const TextField* next) noexcept;
  bool read_values(std::size_t array);
  bool read_reading(float& value) noexcept;
  bool read_whole(std::optional<std::uint64_t>& value) noexcept;
  bool read_counted(const TextField& field, std::optional<std::uint64_t>& value) noexcept;
  bool read_number(double& value) noexcept;
  bool read_clock(std::uint64_t& nanos) noexcept;
  bool read_datetime(std::uint64_t& nanos) noexcept;
  bool read_array(const TextField* next, Piece& piece);
  void skip_blanks() noexcept;
  bool skip_separator() noexcept;
  [[nodiscard]] bool is_plain_separator() const noexcept;

  const Layout& layout_;
  const TextLayout& text_;
  std::size_t array_;
  bool names_array_;  ///< A field says whose readings a line has.
  bool has_plain_separators_;
  std::vector<std::size_t> counts_;  ///< Readings of each array in a line.
  std::vector<float> numbers_;
  std::vector<float> others_;  ///< Readings of other arrays.
  const std::uint8_t* at_ = nullptr;
  const std::uint8_t* end_ = nullptr;
  const char* why_ = "";
};

}  // namespace dermis::layouts
