// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dermis/out/report/svg.hpp"
#include "dermis/paper/paper_report.hpp"

namespace dermis::paper {

/// A curve can be drawn where it has points: as many values as steps.
[[nodiscard]] bool has_points(const TrainingCurve& curve);

/// The final error of the curve: the mean of its last tenth, for the errors of batches are noisy. It must have points.
[[nodiscard]] double final_error(const TrainingCurve& curve);

/// Errors over the steps, both logarithmic. Steps that are less than 2 % apart are drawn as one, with their mean error.
struct TrainingPlot {
  struct Series {
    std::size_t style = 0;
    const TrainingCurve* curve = nullptr;
  };

  std::string title;
  std::string error;           ///< Name of the values: "E, eq. (2)".
  std::vector<Series> series;  ///< At least one, all with points.
  std::optional<double> goal;  ///< Of eq. (2), drawn across.
};

[[nodiscard]] out::report::Drawing training_plot(const TrainingPlot& training);

}  // namespace dermis::paper
