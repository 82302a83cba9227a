// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bytes/layouts/frame_assembly.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::layouts {

/// Reads the lines of a layout. Keeps the readings of one array of those that a line has.
class LineMatch {
 public:
  LineMatch(const Layout& layout, std::size_t array);

  /// Reads a line without its end. The byte behind it must be there, and be no part of a number. `piece` has what heads
  /// before it said, too. False where the line does not fit; then misfit() says where and why.
  [[nodiscard]] bool read(std::span<const std::uint8_t> line, Piece& piece);

  /// The last line that fitted has no readings of any array.
  [[nodiscard]] bool is_head() const noexcept { return pattern_->is_head; }
  /// It is the head of a frame, not of a part of it.
  [[nodiscard]] bool begins_frame() const noexcept { return pattern_->begins_frame; }
  /// The readings of the array in that line.
  [[nodiscard]] std::span<const float> numbers() const noexcept { return {numbers_.data(), count_}; }
  /// "at 'xyz': a number is expected", of the last line that did not fit.
  [[nodiscard]] std::string misfit() const;
  /// "a number is expected"
  [[nodiscard]] std::string_view why() const noexcept { return why_; }

 private:
  /// How many readings of an array stand in a line.
  enum class Holds { taxel, row, frame, row_or_frame };

  struct Pattern {
    const TextLayout::Pattern* fields = nullptr;
    Holds holds = Holds::frame;
    std::vector<std::size_t> shares{};  ///< Fields of each array, which share what the line holds of it.
    bool is_head = false;
    bool begins_frame = false;
    bool has_temperature = false;
  };

  [[nodiscard]] Pattern pattern_of(const TextLayout::Pattern& fields) const;
  bool read_pattern(std::span<const std::uint8_t> line, Piece& piece);
  bool fail(const char* why) noexcept;
  bool read_field(const TextField& field, const TextField* next, Piece& piece);
  bool read_literal(const std::string& literal) noexcept;
  bool skip_to(const TextField* next) noexcept;
  bool read_readings(const TextField& field, std::size_t array, Piece& piece);
  bool read_values(std::span<float> values, std::size_t from, std::size_t to) noexcept;
  std::size_t read_plain(std::span<float> values) noexcept;
  bool read_reading(float& value) noexcept;
  bool read_digits(float& value) noexcept;
  bool skip_absent() noexcept;
  bool read_whole(std::optional<std::uint64_t>& value, const TextField& field) noexcept;
  bool read_number_of(const TextField& field, double& number) noexcept;
  bool read_counted(const TextField& field, std::optional<std::uint64_t>& value) noexcept;
  bool read_number(double& value) noexcept;
  bool read_clock(std::uint64_t& nanos) noexcept;
  bool read_datetime(std::uint64_t& nanos) noexcept;
  bool read_zone(std::int64_t& east_ns) noexcept;
  bool read_array(const TextField* next, Piece& piece);
  [[nodiscard]] std::string_view rest() const noexcept {
    return {reinterpret_cast<const char*>(at_), static_cast<std::size_t>(end_ - at_)};
  }
  void skip_blanks() noexcept;
  bool skip_separator() noexcept;

  const Layout& layout_;
  const TextLayout& text_;
  std::size_t array_;
  bool names_array_;           ///< A field says whose readings a line has.
  bool has_plain_separators_;  ///< Of decimal numbers.
  std::vector<Pattern> patterns_;
  const Pattern* pattern_ = nullptr;  ///< Of the line.
  Piece heads_;                       ///< What the heads so far said.
  std::vector<float> numbers_;
  std::size_t count_ = 0;      ///< Of them.
  std::vector<float> others_;  ///< Readings of other arrays.
  const std::uint8_t* at_ = nullptr;
  const std::uint8_t* end_ = nullptr;
  const std::uint8_t* misfit_at_ = nullptr;  ///< The furthest that a pattern fitted.
  const char* why_ = "";
};

}  // namespace dermis::bytes::layouts
