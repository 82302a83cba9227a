// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/recognition/learning.hpp"
#include "learn/recognition/learning/expert_fusion.hpp"
#include "learn/recognition/learning/folds.hpp"

namespace dermis::learn::recognition {

/// How right the fused answer is on examples that were not learned from; the weights, too, are those that the other
/// folds ask for.
[[nodiscard]] LearningReport judge(const Judged& judged, const Folds& folds, const std::vector<Label>& labels,
                                   const std::vector<Matrix>& scores);

}  // namespace dermis::learn::recognition
