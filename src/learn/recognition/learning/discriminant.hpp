// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "learn/recognition/features/standardisation.hpp"

/// The linear discriminant with a shrunken covariance: docs/reasons/recognition.md, eqs. (1) to (3).
namespace dermis::learn::recognition {

inline constexpr std::array kShrinkages{0.003, 0.01, 0.03, 0.1, 0.3, 0.6, 0.8, 0.9, 0.97};

/// The examples of a discriminant.
struct Teaching {
  Matrix examples;                   ///< [examples, columns]
  std::vector<std::size_t> classes;  ///< Of each, below `class_count`.
  std::size_t class_count = 0;
  /// [any, columns]: differences that do not distinguish classes. Their squares are added to those within the classes.
  Matrix strays{};
};

/// Scores that examples give to others, [others, classes], for every shrinkage from one eigendecomposition; 0 for
/// classes without an example.
[[nodiscard]] std::array<Matrix, kShrinkages.size()> score_others(const Teaching& teaching, const Matrix& others);

/// The space that the means of the classes span, in which the covariance is 1: y = axes z.
struct Discriminant {
  Matrix axes;   ///< [rank, columns]; rank: at most the classes and at most the columns
  Matrix means;  ///< [classes, rank] of the classes, in that space

  /// [others, classes]: to the means of the classes.
  [[nodiscard]] Matrix distances(const Matrix& others) const;
};
[[nodiscard]] Discriminant train_discriminant(const Teaching& teaching, double shrinkage);

}  // namespace dermis::learn::recognition
