// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/axis.hpp"

namespace dermis::learn::health {

/// Lines of one axis that always read the same because an address line of their multiplexer does not switch. Lines
/// whose numbers differ in that bit alone are then equal.
class EqualLines {
 public:
  /// `array` must outlive it.
  EqualLines(const ArrayDescription& array, Axis axis);

  /// `change`: how far each reading is from that at rest [taxels]; from `strong` on it shows a press.
  void add(std::span<const float> counts, std::span<const float> change, float strong);

  /// A sentence for each address line that does not switch. `crossing`: the lines of the other axis.
  [[nodiscard]] std::vector<std::string> findings(const EqualLines& crossing) const;

 private:
  /// Readings under presses on one of two lines, and how many of them are the same on both.
  struct Agreement {
    std::size_t presses = 0;
    std::size_t equal = 0;
    std::size_t stronger = 0;  // on the first one, of those that differ
  };
  /// Pairs of lines that were pressed.
  struct Pairs {
    std::size_t pressed = 0;
    std::size_t equal = 0;      // nearly all readings are
    std::size_t different = 0;  // many readings are
    std::size_t falling = 0;    // of these, some are stronger on the first line
    std::size_t rising = 0;     // and some on the second one
    std::size_t both_ways = 0;  // pairs that are falling and rising
    std::size_t presses = 0;

    void add(const Agreement& both) noexcept;
    [[nodiscard]] bool are_equal() const noexcept;
    [[nodiscard]] bool are_different() const noexcept;
  };

  void compare(std::size_t line, std::size_t other, std::span<const float> counts, std::span<const float> change,
               float strong, Agreement& agreement) const;
  void add_pairs(std::size_t bit, bool is_set, Pairs& pairs) const;
  [[nodiscard]] Pairs neighbours() const;
  [[nodiscard]] bool does_not_switch(std::size_t bit) const;
  [[nodiscard]] std::string name_pairs(std::size_t bit) const;

  const ArrayDescription* array_;
  Axis axis_;
  std::vector<std::vector<Agreement>> agreements_;  // [bit][line], of the line and the one that is 2^bit further
};

}  // namespace dermis::learn::health
