// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <span>
#include <string>

#include "dermis/learn/recognition/dataset.hpp"
#include "dermis/learn/recognition/learning.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::recognition {

/// The names that an answer of predictions_of() may contain.
enum class Answers {
  classes,             ///< Always the likeliest class.
  classes_or_unknown,  ///< Or "unknown"; the lines have the score of it, too.
};

/// The answers to the labels that the splits ask for, each split learned anew: a CSV with the columns
/// split,id,class,probability. With classes_or_unknown it also has unknown_score. `set`: of all labels of `data`.
/// `progress` gets the share that is done. Errors name the split.
[[nodiscard]] Result<std::string> predictions_of(const LabelledFrames& data, const LearningSet& set,
                                                 std::span<const Split> splits, Answers answers,
                                                 const std::function<void(double)>& progress = {});

}  // namespace dermis::learn::recognition
