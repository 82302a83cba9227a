// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/learn/recognition/examples.hpp"
#include "dermis/learn/recognition/learning.hpp"
#include "dermis/touch/frames/result.hpp"

/// Estimators side by side: each learns what the recipe of docs/reasons/recognition.md learns, and is asked what it is
/// asked.
namespace dermis::learn::recognition {

/// The input of an estimator in one fold: the examples that it learns from and those that it is asked about. Features
/// have mean 0 and deviation 1 over the taught examples, and are within +-4.
struct Lesson {
  std::size_t features = 0;           ///< Of an example.
  std::size_t classes = 0;            ///< Number of classes, some perhaps without an example here.
  std::vector<float> taught;          ///< [examples, features]
  std::vector<std::size_t> class_of;  ///< Of each example that is taught.
  std::vector<std::size_t> fold_of;   ///< Folds of the same examples: those of one fold belong together.
  std::vector<float> asked;           ///< [asked, features]
};

struct ComparedEstimator {
  std::string name;
  /// Answers with probabilities, [asked, classes].
  std::function<Result<std::vector<float>>(const Lesson&)> answer;
};

struct EstimatorFigures {
  std::string name;
  double accuracy = 0.0;                      ///< Share that is right, 0 ... 1.
  std::optional<double> calibration_error{};  ///< 0 ... 1; empty of one that gives no probabilities.
};

/// Compares the recipe as `learned` has it, the nearest frame and `further` estimators by the same folds. The nearest
/// frame gives the class of the example whose held image, over the root of its mean square, differs least. `set` and
/// `learned`: of all labels of `data`. `progress` gets the share that is done.
[[nodiscard]] Result<std::vector<EstimatorFigures>> compare_estimators(
    const LabelledFrames& data, const LearningSet& set, const Learned& learned,
    std::span<const ComparedEstimator> further, const std::function<void(double)>& progress = {});

}  // namespace dermis::learn::recognition
