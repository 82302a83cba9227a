// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::out::report {

enum class TerminalColours {
  rgb,      ///< 24 bits.
  cube,     ///< The 6x6x6 cube of xterm's 256.
  without,  ///< Letters instead.
};

struct TerminalSize {
  std::size_t lines = 24;
  std::size_t columns = 80;
};

/// The picture of an array.
struct TerminalPicture {
  std::string name;
  std::string unit;
  FrameShape shape;            ///< 1x1 at least.
  std::vector<double> values;  ///< Values of the taxels; NaN where there is none.
  double high = 1.0;           ///< End of the colour scale.
  bool has_contacts = false;   ///< There is a model.
  ContactReport report;
  SourceStatistics statistics;
  bool has_ended = false;
};

/// The whole screen: what is written to a terminal of that size at its home position. Taxels are squares of half
/// blocks; where they do not fit, each stands for the largest of its neighbours. The last line has no end.
[[nodiscard]] std::string terminal_screen(const TerminalPicture& picture, const TerminalSize& size,
                                          TerminalColours colours);

}  // namespace dermis::out::report
