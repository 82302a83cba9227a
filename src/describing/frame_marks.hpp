// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "describing/lines.hpp"

namespace dermis::describing {

/// Something comes after every so many lines of readings.
struct FrameMark {
  std::string text;      ///< What such a line begins with; "": it is empty.
  std::size_t rows = 0;  ///< Lines of readings from one to the next.
};

/// `members`: places of the lines that hold readings.
[[nodiscard]] std::optional<FrameMark> frame_mark_of(const std::vector<Line>& lines,
                                                     const std::vector<std::size_t>& members);

}  // namespace dermis::describing
