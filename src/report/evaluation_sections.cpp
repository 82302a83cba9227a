// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "report/evaluation_sections.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dermis/report/estimator_table.hpp"
#include "dermis/report/wording.hpp"

namespace dermis::report {
namespace {

using calibration::EstimatorResult;
using calibration::Evaluation;

/// "20 ohm", or "18 to 22 ohm" where the lines differ.
std::string resistances(const std::vector<double>& ohms) {
  const auto [low, high] = std::minmax_element(ohms.begin(), ohms.end());
  if (*low == *high) return fmt::format("{:.4g} ohm", *low);
  return fmt::format("{:.4g} to {:.4g} ohm", *low, *high);
}

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

void add_estimators(Page& page, const Evaluation& evaluation, const pipeline::Model& model) {
  const Table table = estimator_table(evaluation);
  if (table.rows.empty()) return;
  page.heading("Estimators side by side");
  page.table(table);
  add_estimator_legend(page, evaluation, model);
  page.heading("Figures");
}

void add_array(Page& page, const ArrayDescription& array) {
  const Readout& readout = array.readout;
  std::vector<Fact> facts = {
      {"name", array.name},
      {"taxels", fmt::format("{} rows x {} columns", array.rows, array.cols)},
      {"pitch", fmt::format("{:.4g} mm x {:.4g} mm", 1e3 * array.row_pitch_m, 1e3 * array.col_pitch_m)}};
  if (array.taxel_area_m2) {
    facts.emplace_back("pressed area of a taxel", fmt::format("{:.4g} mm\u00b2", 1e6 * *array.taxel_area_m2));
  }
  facts.emplace_back("circuit", to_string(readout.circuit));
  if (readout.circuit == Circuit::divider || readout.circuit == Circuit::transimpedance) {
    facts.emplace_back("idle rows", to_string(readout.idle_rows));
  }
  if (readout.circuit == Circuit::divider) facts.emplace_back("idle columns", to_string(readout.idle_columns));
  if (!readout.drive_ohm.empty()) facts.emplace_back("drive", resistances(readout.drive_ohm));
  if (!readout.load_ohm.empty()) facts.emplace_back("load", resistances(readout.load_ohm));
  if (!readout.row_segment_ohm.empty()) {
    facts.emplace_back("row lines, a taxel", resistances(readout.row_segment_ohm));
  }
  if (!readout.column_segment_ohm.empty()) {
    facts.emplace_back("column lines, a taxel", resistances(readout.column_segment_ohm));
  }
  facts.emplace_back("ADC", fmt::format("{} bit", readout.adc_bits));
  if (readout.supply_v) facts.emplace_back("nominal supply", fmt::format("{:.4g} V", *readout.supply_v));
  page.heading("Array");
  page.facts(facts);
}

void add_origin(Page& page, const Origin& origin) {
  if (origin.facts.empty()) return;
  page.heading("What was judged");
  page.facts(origin.facts);
}

void add_provenance(Page& page, const pipeline::Model& model) {
  page.heading("Provenance of the model");
  if (model.provenance.empty()) {
    page.paragraph("The model says nothing about its calibration.");
    return;
  }
  std::vector<Fact> facts;
  for (const auto& [name, text] : model.provenance) facts.emplace_back(name, with_signs(text));
  page.facts(facts);
}

}  // namespace dermis::report
