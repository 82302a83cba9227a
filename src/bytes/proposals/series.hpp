// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What a number tells that comes again in each line or packet.
namespace dermis::bytes::proposals {

using Series = std::vector<double>;

/// Counts through the same whole numbers again and again, up or down; each may stay for a while.
struct Cycle {
  std::uint64_t first = 0;  ///< The smallest.
  std::size_t count = 0;
};

[[nodiscard]] std::optional<Cycle> cycle_of(const Series& series);

/// Grows by 1, after which it may stay for a while. A number that wraps does so at `modulus`; 0: never.
[[nodiscard]] bool is_frame_number(const Series& series, double modulus);

/// Grows evenly, or never falls; `modulus` as above.
[[nodiscard]] bool is_time(const Series& series, double modulus);

/// Grows by steps that are all nearly as long, and not by 1: its high bytes alone may seem to count.
[[nodiscard]] bool is_even_clock(const Series& series, double modulus);

/// "time_ms" of such a series: the unit in which its steps and its value make sense.
[[nodiscard]] std::string time_field_of(const Series& series, double modulus);

/// The different numbers, 2 to 64, that come in turn, in order of size; empty where they do not.
[[nodiscard]] std::vector<std::uint64_t> numbers_in_turn(const Series& series);

}  // namespace dermis::bytes::proposals
