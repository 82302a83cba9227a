// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>

namespace dermis::out::report {

/// A number >= 0 with two significant digits, or whole from 10 on: "0.58", "2.4", "51".
[[nodiscard]] std::string two_digits(double value);

/// A relative error as "2.4 %". One that is not finite reads "no force": it stands for taxels without an estimate.
[[nodiscard]] std::string percent(double fraction);

/// The same in more digits, where a limit must not be rounded over: "5.02 %", which no line breaks.
[[nodiscard]] std::string fine_percent(double fraction);

/// Any number with three significant digits, or "-" for what is not finite.
[[nodiscard]] std::string three_digits(double value);

/// "0.031 N", or "no force".
[[nodiscard]] std::string newtons(double force);

/// "12,345"
[[nodiscard]] std::string grouped(std::size_t count);

/// "2,000 steps", for a number of steps as curves carry it.
[[nodiscard]] std::string steps(double count);

/// "1 frame", "12 frames"
[[nodiscard]] std::string counted(std::size_t count, const std::string& noun);

/// The name of an estimator for people: "raw_lookup" is "raw look-up".
[[nodiscard]] std::string estimator_words(std::string name);

}  // namespace dermis::out::report
