// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bytes/proposals/lines.hpp"

namespace dermis::bytes::proposals {

/// Something comes after every so many lines of readings.
struct FrameMark {
  std::string text;                  ///< What such a line begins with; "": it is empty.
  std::size_t rows = 0;              ///< Lines of readings from one to the next.
  std::vector<std::size_t> lines{};  ///< Places of those that hold no readings.
};

/// `members`: places of the lines that hold readings.
[[nodiscard]] std::vector<FrameMark> frame_marks_of(const std::vector<Line>& lines,
                                                    const std::vector<std::size_t>& members);

}  // namespace dermis::bytes::proposals
