// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/learn/recognition/classes.hpp"
#include "dermis/learn/recognition/examples.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::recognition {

/// The answers of classes to labels that they have not learned from.
struct ClassesEvaluation {
  std::vector<std::size_t> confusion;  ///< [classes, classes]: right class, likeliest class.
  std::size_t judged = 0;              ///< Labels in `confusion`: of the classes that were learned.
  double accuracy = 0.0;               ///< Share of those whose likeliest class is right, 0 ... 1.
  double calibration_error = 0.0;      ///< Expected calibration error over 10 bins, 0 ... 1.
  std::size_t called_unknown = 0;      ///< Of `judged`: the answer was "unknown".
  std::size_t others = 0;              ///< Labels of classes that were not learned.
  std::size_t others_unknown = 0;      ///< Of `others`: the answer was "unknown".
};

/// Fails where the classes cannot read the frames, on all that LabelledFrames::validate() refuses, and where no label
/// is of a learned class.
[[nodiscard]] Result<ClassesEvaluation> evaluate_classes(const Classes& classes, const LabelledFrames& data);

}  // namespace dermis::learn::recognition
