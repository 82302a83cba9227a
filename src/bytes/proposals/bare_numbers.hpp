// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bytes/proposals/lines.hpp"

/// Lines that have one number each.
namespace dermis::bytes::proposals {

/// A number that is no reading, and begins a frame.
struct NumberMark {
  std::string text;
  std::size_t numbers = 0;  ///< From one to the next.
};

/// The number that comes at even distances, and nowhere else. `members`: places of the lines.
[[nodiscard]] std::optional<NumberMark> number_that_marks(const std::vector<Line>& lines,
                                                          const std::vector<std::size_t>& members);

/// After how many numbers they come again nearly as they were; 0 where nothing shows it.
[[nodiscard]] std::size_t period_of_numbers(const std::vector<Line>& lines, const std::vector<std::size_t>& members);

}  // namespace dermis::bytes::proposals
