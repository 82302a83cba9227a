// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/out/report/page.hpp"

namespace dermis::out::report {

/// The forces of the estimators against the known loads, as in the paper's Fig. 11 to 13. There is a panel for each
/// level of force, where the loads have a few levels, or else for each estimator.
[[nodiscard]] Figure calibration_figure(const learn::calibration::Evaluation& evaluation);

/// Errors against force, temperature, supply, number of contacts and time since the onset.
[[nodiscard]] std::vector<Figure> breakdown_figures(const learn::calibration::Evaluation& evaluation);

/// Share of the true forces that lie within the interval of a given probability: a straight line where the standard
/// deviations are right. No panel where nothing was judged.
[[nodiscard]] Figure coverage_figure(const learn::calibration::Evaluation& evaluation);

/// A load over time as dermis gives it, beside the truth, and its loop of loading and unloading. No panel where the
/// labels have no evidence on time.
[[nodiscard]] Figure touch_figure(const learn::calibration::Evaluation& evaluation);

/// Tactile images of the example frames.
[[nodiscard]] std::vector<Figure> tactile_figures(const learn::calibration::Evaluation& evaluation);

}  // namespace dermis::out::report
