// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dermis/paper/paper_report.hpp"

namespace dermis::paper {

enum class Verdict : std::uint8_t {
  holds,
  holds_scaled,  ///< With targets scaled to [0, 1], not in the units of the function.
  fails,
  open,  ///< Cannot be judged.
};

[[nodiscard]] std::string to_words(Verdict verdict);

/// A claim of the paper, and the finding.
struct Claim {
  std::string where;  ///< "eq. (2), Fig. 5"
  std::string claimed;
  std::string found;
  Verdict verdict = Verdict::open;
};

/// The claims of the paper in its order.
[[nodiscard]] std::vector<Claim> judge(const PaperReproduction& reproduction);

/// Unknowns of the paper's bank: N networks N-N-N-1.
struct UnknownCount {
  std::size_t n = 0;
  std::size_t connections = 0;  ///< 2 N^3 + N^2
  std::size_t thresholds = 0;   ///< 2 N^2 + N
};
[[nodiscard]] UnknownCount count_unknowns(std::size_t n);

/// For N = 256.
inline constexpr std::size_t kPaperUnknowns = 33751296;

}  // namespace dermis::paper
