// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>

#include "dermis/learn/recognition/learning.hpp"
#include "learn/recognition/learning/expert_choice.hpp"
#include "learn/recognition/learning/folds.hpp"

namespace dermis::learn::recognition {

/// The two classes that are taken for each other most often, as `report` has it; empty where none are. Their
/// differences are judged by the same folds.
[[nodiscard]] std::optional<ConfusedPair> find_confused_pair(const LearningReport& report, const TrainingTable& table,
                                                             const std::vector<ExpertColumns>& aspects,
                                                             const Folds& folds);

}  // namespace dermis::learn::recognition
