// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/learn/recognition/examples.hpp"

namespace dermis::learn::recognition {

/// How the examples are divided, so that each is judged by what it did not teach.
struct Folds {
  enum class Kind { by_group, by_time };
  Kind kind = Kind::by_time;
  std::vector<std::size_t> fold_of;  ///< Fold of each example, 0 ... count - 1.
  std::size_t count = 0;
};

/// How the examples of a class are dealt out where no group parts them.
enum class Deal {
  in_turns,  ///< One after the other, in order of time, to ten folds: each sees all times.
  in_runs,   ///< A run of them, in order of time, to each of five: each is of a time that the others have not seen.
};

/// Whether a fold with so many examples of a class leaves too few of `all` to learn it from: less than a quarter.
[[nodiscard]] constexpr bool is_lopsided(std::size_t of_fold, std::size_t all) noexcept {
  return 4 * (all - of_fold) < all;
}

/// Whole groups (subjects, sessions) in at most ten folds, where all labels name one and no fold is lopsided for most
/// examples. Else the examples of each class as `deal` says.
[[nodiscard]] Folds make_folds(const std::vector<Label>& labels, const std::vector<std::size_t>& classes, Deal deal);

}  // namespace dermis::learn::recognition
