// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "dermis/live/buses/can_map.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

/// Logs of `candump` (can-utils) as frames.
namespace dermis::live::buses {

/// A line of a log: "(1436509052.249713) vcan0 044#2A366C2BBA", or "vcan0  044   [5]  2A 36 6C 2B BA".
struct CandumpLine {
  std::optional<Nanos> time;
  std::string interface;
  CanFrame frame;
  bool has_data = true;  ///< False: a remote frame, or one that tells an error of the bus.
};

/// Empty where the text is no such line.
[[nodiscard]] std::optional<CandumpLine> parse_candump_line(std::string_view text);

struct CandumpOptions {
  std::string interface {};         ///< Empty: the only one with frames of the array.
  std::optional<double> rate_hz{};  ///< Frames a second of a log without times.
};

/// The frames of one array. Fails, with the line, on what is no log, on times that go back, and on frames of the array
/// from two interfaces. `name` stands for the path in messages. The memory is that of a frame and a line.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_candump(std::unique_ptr<std::istream> in,
                                                                const std::string& name, const CanArray& array,
                                                                const CandumpOptions& options);

}  // namespace dermis::live::buses
