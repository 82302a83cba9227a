// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>

#include "dermis/recognition/learning.hpp"
#include "recognition/learning/expert_choice.hpp"
#include "recognition/learning/folds.hpp"

namespace dermis::recognition {

/// The two classes that are taken for each other most often, as `report` has it; empty where none are. Their
/// differences are judged by the same folds.
[[nodiscard]] std::optional<ConfusedPair> find_confused_pair(const LearningReport& report, const TrainingTable& table,
                                                             const std::vector<ExpertColumns>& aspects,
                                                             const Folds& folds);

}  // namespace dermis::recognition
