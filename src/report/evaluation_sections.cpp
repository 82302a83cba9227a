// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "report/evaluation_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "report/wording.hpp"

namespace dermis::report {
namespace {

using calibration::EstimatorResult;
using calibration::Evaluation;

/// One column of the table of estimators: the smaller the better, except for shares.
struct Column {
  std::string group;
  std::string head;
  std::string headline;  ///< Name among the large numbers; empty for columns that are not there.
  std::function<std::optional<double>(std::size_t)> value;
  std::string (*words)(double);
  bool larger_is_better = false;
};

std::string share_words(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}

std::vector<Column> table_columns(const Evaluation& evaluation) {
  const auto of = [&](auto member) {
    return [&evaluation, member](std::size_t i) { return std::invoke(member, evaluation.estimators[i]); };
  };
  const std::string single = "relative error";
  const std::string ghost = "ghost force";
  const std::string total = "totals";
  std::vector<Column> columns = {
      {single, "median", "median error", of([](const EstimatorResult& e) { return e.relative_error.median; }), percent},
      {single, "p95", "p95 error", of([](const EstimatorResult& e) { return e.relative_error.p95; }), percent},
      {single, "p99", "p99 error", of([](const EstimatorResult& e) { return e.relative_error.p99; }), percent},
      {single, "max", "largest error", of([](const EstimatorResult& e) { return e.relative_error.max; }), percent},
      {single, "within 5 %", "",
       [&evaluation](std::size_t i) {
         const double share = share_within(evaluation, i, kPaperTolerance);
         return std::isnan(share) ? std::nullopt : std::optional(share);
       },
       share_words, true},
      {ghost, "p99", "ghost force p99", of([](const EstimatorResult& e) { return e.ghost_n.p99; }), newtons},
      {ghost, "max", "", of([](const EstimatorResult& e) { return e.ghost_n.max; }), newtons},
      {total, "RMSE", "RMSE of totals", of([](const EstimatorResult& e) { return e.total_rmse_n; }), newtons},
      {total, "median", "", of([](const EstimatorResult& e) { return e.total_relative_error.median; }), percent},
      {total, "p95", "p95 of totals", of([](const EstimatorResult& e) { return e.total_relative_error.p95; }),
       percent}};
  std::erase_if(columns, [&](const Column& column) {
    for (std::size_t i = 0; i < evaluation.estimators.size(); ++i) {
      if (column.value(i)) return false;
    }
    return true;
  });
  return columns;
}

std::vector<Table::Group> groups_of(const std::vector<Column>& columns) {
  std::vector<Table::Group> groups;
  for (const Column& column : columns) {
    if (groups.empty() || groups.back().name != column.group) groups.push_back({column.group, 0});
    ++groups.back().columns;
  }
  return groups;
}

/// The best finite value of the estimators from `first` on.
std::optional<double> best_value(const Column& column, std::size_t first, std::size_t estimators) {
  std::optional<double> best;
  for (std::size_t i = first; i < estimators; ++i) {
    const std::optional<double> value = column.value(i);
    if (!value || !std::isfinite(*value)) continue;
    if (!best || (column.larger_is_better ? *value > *best : *value < *best)) best = value;
  }
  return best;
}

std::string describe(const pipeline::Model& model) {
  const char* before =
      model.array.readout.circuit == Circuit::none ? "the readings" : "the exact inversion of the circuit";
  return fmt::format("after {}, BP networks of {}-{}-1 units per taxel: conductance{} to newtons", before,
                     model.networks.shape.inputs, model.networks.shape.hidden,
                     model.networks.shape.inputs > 1 ? " and temperature" : "");
}

std::string describe(const fusion::LookUpTables& tables) {
  const bool knows_temperature =
      std::any_of(tables.temperature_coefficient.begin(), tables.temperature_coefficient.end(),
                  [](double coefficient) { return coefficient != 0.0; });
  return fmt::format("a look-up table per taxel, from the {} to newtons{}",
                     tables.signal == fusion::LookUpSignal::reading ? "raw reading" : "conductance without crosstalk",
                     knows_temperature ? ", with a temperature coefficient" : "");
}

/// N as in the paper: the number of taxels.
std::string describe_paper_bank(std::size_t taxels) {
  return fmt::format(
      "the paper's bank: one N-N-N-1 network a taxel, N = {}, from the readings of the whole array, and the "
      "temperature where "
      "the calibration varies it, to newtons; it is told nothing of the circuit",
      grouped(taxels));
}

/// "20 ohm", or "18 ... 22 ohm" where the lines differ.
std::string resistances(const std::vector<double>& ohms) {
  const auto [low, high] = std::minmax_element(ohms.begin(), ohms.end());
  if (*low == *high) return fmt::format("{:.4g} ohm", *low);
  return fmt::format("{:.4g} ... {:.4g} ohm", *low, *high);
}

std::string summary_sentence(const Evaluation& evaluation) {
  const EstimatorResult& first = evaluation.estimators.front();
  std::string sentence = first.name + " on ";
  if (first.relative_error.count > 0) {
    sentence += counted(first.relative_error.count, "loaded taxel") + " of at least 1 N";
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
  std::vector<Tile> tiles;
  for (const Column& column : table_columns(evaluation)) {
    if (column.headline.empty() || !column.value(0)) continue;
    const std::optional<double> other = best_value(column, 1, evaluation.estimators.size());
    tiles.push_back(
        {column.headline, column.words(*column.value(0)), other ? "best other: " + column.words(*other) : ""});
  }
  page.tiles(tiles);
}

void add_estimators(Page& page, const Evaluation& evaluation, const pipeline::Model& model) {
  const Table table = estimator_table(evaluation);
  if (table.rows.empty()) return;
  page.heading("Estimators side by side");
  page.table(table);
  add_legend(page, evaluation, model);
  page.heading("Figures");
}

Table estimator_table(const Evaluation& evaluation) {
  const std::vector<Column> columns = table_columns(evaluation);
  if (columns.empty()) return {};
  Table table{"numbers", groups_of(columns), {"estimator"}, {}};
  for (const Column& column : columns) table.heads.push_back(column.head);
  const std::size_t count = evaluation.estimators.size();
  for (std::size_t i = 0; i < count; ++i) {
    Row row{i, evaluation.estimators[i].name, {}};
    for (const Column& column : columns) {
      const std::optional<double> value = column.value(i);
      const bool is_best = count > 1 && value && value == best_value(column, 0, count);
      row.cells.push_back({value ? column.words(*value) : "-", is_best ? "best" : ""});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

void add_legend(Page& page, const Evaluation& evaluation, const pipeline::Model& model) {
  page.paragraph(
      "Relative errors are those of taxels that carry at least 1 N; ghost: force reported on unloaded "
      "taxels; total: sum over the taxels of one load. Bold: the best of a column. \"No force\": the "
      "percentile falls on taxels without an estimate, which count as the worst error.",
      "note");
  std::vector<Fact> facts;
  if (!evaluation.estimators.empty()) facts.emplace_back(evaluation.estimators.front().name, describe(model));
  for (const fusion::LookUpTables& tables : model.baselines) facts.emplace_back(tables.name, describe(tables));
  for (const EstimatorResult& estimator : evaluation.estimators) {
    if (estimator.name != calibration::kPaperBankName) continue;
    facts.emplace_back(estimator.name, describe_paper_bank(evaluation.array.taxel_count()));
  }
  page.facts(facts, "facts note");
}

void add_array(Page& page, const ArrayDescription& array) {
  const Readout& readout = array.readout;
  std::vector<Fact> facts = {
      {"name", array.name},
      {"taxels", fmt::format("{} rows x {} columns", array.rows, array.cols)},
      {"pitch", fmt::format("{:.4g} mm x {:.4g} mm", 1e3 * array.row_pitch_m, 1e3 * array.col_pitch_m)}};
  if (array.taxel_area_m2) {
    facts.emplace_back("pressed area of a taxel", fmt::format("{:.4g} mm2", 1e6 * *array.taxel_area_m2));
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

void add_provenance(Page& page, const pipeline::Model& model) {
  page.heading("Provenance of the model");
  if (model.provenance.empty()) {
    page.paragraph("The model says nothing about its calibration.");
    return;
  }
  page.facts({model.provenance.begin(), model.provenance.end()});
}

}  // namespace dermis::report
