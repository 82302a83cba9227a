// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string>

#include "dermis/core/result.hpp"
#include "dermis/recognition/comparison.hpp"
#include "dermis/recognition/examples.hpp"
#include "dermis/recognition/learning.hpp"

namespace dermis::report {

/// The results of 'dermis learn' as a page: accuracy, advice, estimators side by side, confusion, and the worst errors.
/// `learned`: of all labels of `data`.
[[nodiscard]] std::string recognition_page(const recognition::LabelledFrames& data, const recognition::Learned& learned,
                                           std::span<const recognition::EstimatorFigures> estimators);

/// The page as `directory`/index.html, and beside it every figure as SVG.
[[nodiscard]] Status write_recognition_report(const std::string& directory, const recognition::LabelledFrames& data,
                                              const recognition::Learned& learned,
                                              std::span<const recognition::EstimatorFigures> estimators);

}  // namespace dermis::report
