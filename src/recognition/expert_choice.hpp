// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "recognition/discriminant.hpp"
#include "recognition/expert_fusion.hpp"
#include "recognition/feature_columns.hpp"
#include "recognition/folds.hpp"

namespace dermis::recognition {

/// What is learned from.
struct TrainingTable {
  const Matrix& features;            ///< [segments, features]
  std::vector<std::size_t> rows;     ///< Of the examples.
  std::vector<std::size_t> classes;  ///< Of each example.
  std::size_t class_count = 0;
};

/// Which classes the others of each fold know.
[[nodiscard]] Judged judged_by(const Folds& folds, const std::vector<std::size_t>& classes, std::size_t class_count);

/// An expert's shrinkage, and what it says of each example by what the other folds taught.
struct ExpertChoice {
  double shrinkage = 0.0;
  double sharpness = 1.0;  ///< What the scores are to be multiplied by.
  Matrix scores{};         ///< [examples, classes], multiplied already
};

/// The shrinkage with the least log loss at its best sharpness.
[[nodiscard]] ExpertChoice choose_expert(const TrainingTable& table, const ExpertColumns& expert, const Folds& folds,
                                         const Judged& judged);

/// [examples, classes]: distances to the means of the classes, by what the other folds taught.
[[nodiscard]] Matrix distances_out_of_fold(const TrainingTable& table, const ExpertColumns& expert, const Folds& folds,
                                           double shrinkage);

}  // namespace dermis::recognition
