// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string>

#include "dermis/learn/recognition/comparison.hpp"
#include "dermis/learn/recognition/examples.hpp"
#include "dermis/learn/recognition/learning.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::report {

/// The results of 'dermis recognise learn' as a page: accuracy, advice, estimators side by side, confusion, and the
/// worst errors. `learned`: of all labels of `data`.
[[nodiscard]] std::string recognition_page(const learn::recognition::LabelledFrames& data,
                                           const learn::recognition::Learned& learned,
                                           std::span<const learn::recognition::EstimatorFigures> estimators);

/// The page as `directory`/index.html, and beside it every figure as SVG.
[[nodiscard]] Status write_recognition_report(const std::string& directory,
                                              const learn::recognition::LabelledFrames& data,
                                              const learn::recognition::Learned& learned,
                                              std::span<const learn::recognition::EstimatorFigures> estimators);

}  // namespace dermis::out::report
