// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "learn/recognition/features/feature_columns.hpp"
#include "learn/recognition/learning/discriminant.hpp"
#include "learn/recognition/learning/expert_fusion.hpp"
#include "learn/recognition/learning/folds.hpp"

namespace dermis::learn::recognition {

/// The data for learning.
struct TrainingTable {
  const Matrix& features;             ///< [segments, features]
  const std::vector<Matrix>& raised;  ///< The same of the segments as they would be with a zero that lies higher.
  std::vector<std::size_t> rows;      ///< Of the examples.
  std::vector<std::size_t> classes;   ///< Of each example.
  std::size_t class_count = 0;
};

/// The teaching by some of the rows for an expert with these features; `classes`: of each of them.
[[nodiscard]] Teaching teaching_of(const TrainingTable& table, const std::vector<std::size_t>& rows,
                                   std::vector<std::size_t> classes, const Standardisation& standardisation,
                                   bool strays);

/// Which classes the others of each fold know.
[[nodiscard]] Judged judged_by(const Folds& folds, const std::vector<std::size_t>& classes, std::size_t class_count);

/// How an expert learns.
struct LearningWay {
  bool strays = false;      ///< Whether the copies with a raised zero are strays.
  double shrinkage = 0.0;   ///< Shrinkage of the covariance; the penalty of a kernel regression.
  double narrowness = 0.0;  ///< Width of the kernels times the number of columns; 0 of a discriminant.
};

/// How an expert learns best, and what it says of each example by what the other folds taught.
struct ExpertChoice {
  LearningWay way{};
  double sharpness = 1.0;  ///< The factor on the scores.
  Matrix scores{};         ///< [examples, classes], multiplied already
};

/// The way with the least log loss at its best sharpness. Kernels have no strays.
[[nodiscard]] ExpertChoice choose_expert(const TrainingTable& table, const ExpertColumns& expert, const Folds& folds,
                                         const Judged& judged, bool strays);

/// [examples, classes]: distances to the classes, by what the other folds taught.
[[nodiscard]] Matrix distances_out_of_fold(const TrainingTable& table, const ExpertColumns& expert, const Folds& folds,
                                           const ExpertChoice& choice);

}  // namespace dermis::learn::recognition
