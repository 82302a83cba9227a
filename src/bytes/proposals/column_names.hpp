// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bytes/proposals/lines.hpp"

namespace dermis::bytes::proposals {

/// The field of a layout that a column of such a name holds: "Timestamp [ms]" -> "time_ms". It is "time" where its unit
/// is not said, and empty for any other name.
[[nodiscard]] std::string field_of_name(std::string_view name);

/// The unit of a part of a time, in seconds: "secs", "stamp.nanosec"; 0 for any other name.
[[nodiscard]] double time_unit_of_name(std::string_view name);

/// A sensor of motion, not of touch: "imu1_ax", "quat_w".
[[nodiscard]] bool is_of_motion(std::string_view name);

/// How likely a reading stands at the key of a JSON object or behind a label, beside others: "adc" 1, "volt" -1.
[[nodiscard]] int rank_of_key(std::string_view key);

/// The unit of readings that such a name says: "kPa"; empty where it says none.
[[nodiscard]] std::string unit_of_name(std::string_view name);

/// The name without its number: "R_ch12" -> "R_ch".
[[nodiscard]] std::string stem_of(std::string_view name);

/// The names in the head of a table for the tokens of `line` that are numbers or times. The head is the nearest line
/// before that has as many cells. Empty where there is none.
[[nodiscard]] std::vector<std::string> names_of_columns(const std::vector<Line>& lines, std::size_t line);

}  // namespace dermis::bytes::proposals
