// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/report/evaluation_sections.hpp"

#include <fmt/format.h>

#include "dermis/out/report/estimator_table.hpp"
#include "dermis/out/report/model_facts.hpp"
#include "dermis/out/report/wording.hpp"

namespace dermis::out::report {
namespace {

using learn::calibration::EstimatorResult;
using learn::calibration::Evaluation;

std::string summary_sentence(const Evaluation& evaluation) {
  const EstimatorResult& first = evaluation.estimators.front();
  std::string sentence = estimator_words(first.name) + " on ";
  if (first.relative_error.count > 0) {
    sentence += counted(first.relative_error.count, "loaded taxel") +
                fmt::format(" of at least {:.3g} N", evaluation.judged_from_n);
    if (first.totals_judged > 0) sentence += " and ";
  }
  if (first.totals_judged > 0) sentence += counted(first.totals_judged, "total") + " over several taxels";
  if (first.relative_error.count == 0 && first.totals_judged == 0) sentence += "unloaded taxels only";
  sentence += ", from " + counted(evaluation.frames, "labelled frame");
  if (evaluation.frames_rejected > 0)
    sentence += "; " + counted(evaluation.frames_rejected, "more frame") + " rejected";
  return sentence + ".";
}

}  // namespace

void add_summary(Page& page, const Evaluation& evaluation) {
  if (evaluation.estimators.empty()) {
    page.paragraph("No estimator was judged.");
    return;
  }
  page.paragraph(summary_sentence(evaluation), "muted");
  page.tiles(headline_tiles(evaluation));
}

void add_estimators(Page& page, const Evaluation& evaluation, const touch::pipeline::Model& model) {
  const Table table = estimator_table(evaluation);
  if (table.rows.empty()) return;
  page.heading("Estimators side by side");
  page.table(table);
  add_estimator_legend(page, evaluation, model);
  page.heading("Figures");
}

void add_array(Page& page, const ArrayDescription& array) {
  page.heading("Array");
  page.facts(array_facts(array));
}

void add_origin(Page& page, const Origin& origin) {
  if (origin.facts.empty()) return;
  page.heading("What was judged");
  page.facts(origin.facts);
}

void add_provenance(Page& page, const touch::pipeline::Model& model) {
  page.heading("Provenance of the model");
  page.facts(calibration_facts(model));
}

}  // namespace dermis::out::report
