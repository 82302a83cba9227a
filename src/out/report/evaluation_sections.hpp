// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/out/report/evaluation_report.hpp"
#include "dermis/out/report/page.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::out::report {

/// The result of the first estimator in large numbers, and what it was judged on.
void add_summary(Page& page, const learn::calibration::Evaluation& evaluation);

/// Errors of all estimators side by side, what each of them is, and the heading of the figures that follow. Nothing
/// where nothing was judged.
void add_estimators(Page& page, const learn::calibration::Evaluation& evaluation, const touch::pipeline::Model& model);

void add_array(Page& page, const ArrayDescription& array);
/// The files that were judged; nothing where none are known.
void add_origin(Page& page, const Origin& origin);
void add_provenance(Page& page, const touch::pipeline::Model& model);

}  // namespace dermis::out::report
