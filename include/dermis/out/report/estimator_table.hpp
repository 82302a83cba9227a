// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/out/report/page.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::out::report {

/// The relative error that the paper claims; the table counts the taxels within it.
inline constexpr double kPaperTolerance = 0.05;

/// Errors of all estimators side by side, the best of each column in bold; without rows where nothing was judged.
[[nodiscard]] Table estimator_table(const learn::calibration::Evaluation& evaluation);

/// The numbers of the first estimator, each beside the best of the others. At least one estimator.
[[nodiscard]] std::vector<Tile> headline_tiles(const learn::calibration::Evaluation& evaluation);

/// How to read the table, and what each estimator is. `model`: that of the evaluation.
void add_estimator_legend(Page& page, const learn::calibration::Evaluation& evaluation,
                          const touch::pipeline::Model& model);

}  // namespace dermis::out::report
