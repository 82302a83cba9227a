// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/estimator_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "dermis/out/report/wording.hpp"

namespace dermis::out::report {
namespace {

using learn::calibration::EstimatorResult;
using learn::calibration::Evaluation;
using learn::calibration::JudgedTaxel;

constexpr const char* kLargestError = "largest error";

/// One column of the table of estimators: the smaller the better, except for shares.
struct Column {
  std::string group;
  std::string head;
  std::string headline;  ///< Name among the large numbers; empty for columns that are not there.
  std::function<std::optional<double>(std::size_t)> value;
  std::string (*words)(double);
  bool larger_is_better = false;
};

/// Share of the judged taxels whose relative error is within `tolerance`; empty where none is judged.
std::optional<double> share_within(const Evaluation& evaluation, std::size_t estimator, double tolerance) {
  std::size_t judged = 0;
  std::size_t within = 0;
  for (const auto& taxel : evaluation.taxels) {
    ++judged;
    if (std::abs(static_cast<double>(taxel.newtons[estimator]) / taxel.true_newtons - 1.0) <= tolerance) ++within;
  }
  if (judged == 0) return std::nullopt;
  return static_cast<double>(within) / static_cast<double>(judged);
}

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
      {single, "max", kLargestError, of([](const EstimatorResult& e) { return e.relative_error.max; }), percent},
      {single, "within 5 %", "", [&evaluation](std::size_t i) { return share_within(evaluation, i, kPaperTolerance); },
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

/// The taxel that the first estimator gets most wrong; null where none is judged.
const JudgedTaxel* worst_taxel(const Evaluation& evaluation) {
  const auto error = [](const JudgedTaxel& taxel) {
    const double relative = std::abs(static_cast<double>(taxel.newtons.front()) / taxel.true_newtons - 1.0);
    return std::isfinite(relative) ? relative : std::numeric_limits<double>::infinity();
  };
  const auto worst = std::max_element(evaluation.taxels.begin(), evaluation.taxels.end(),
                                      [&](const JudgedTaxel& a, const JudgedTaxel& b) { return error(a) < error(b); });
  return worst == evaluation.taxels.end() ? nullptr : &*worst;
}

/// "r5c7 in frame 812: 1.3 N, in truth 1.0 N, beside 48 N"
std::string explain(const JudgedTaxel& taxel, const Evaluation& evaluation) {
  std::string words =
      fmt::format("{} in frame {}: {}, in truth {}", evaluation.array.taxel_name(taxel.taxel), taxel.frame,
                  newtons(static_cast<double>(taxel.newtons.front())), newtons(taxel.true_newtons));
  double heaviest = 0.0;
  for (const JudgedTaxel& other : evaluation.taxels) {
    if (other.frame == taxel.frame) heaviest = std::max(heaviest, other.true_newtons);
  }
  if (heaviest > taxel.true_newtons) words += ", beside " + newtons(heaviest);
  return words;
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

std::string describe(const touch::pipeline::Model& model) {
  const char* before =
      model.array.readout.circuit == Circuit::none ? "the readings" : "the exact inversion of the circuit";
  return fmt::format("after {}, BP networks of {}-{}-1 units per taxel: conductance{} to newtons", before,
                     model.networks.shape.inputs, model.networks.shape.hidden,
                     model.networks.shape.inputs == touch::fusion::kInputsWithTemperature ? " and temperature" : "");
}

std::string describe(const touch::fusion::LookUpTables& tables) {
  const bool knows_temperature =
      std::any_of(tables.temperature_coefficient.begin(), tables.temperature_coefficient.end(),
                  [](double coefficient) { return coefficient != 0.0; });
  return fmt::format(
      "a look-up table per taxel, from the {} to newtons{}",
      tables.signal == touch::fusion::LookUpSignal::reading ? "raw reading" : "conductance without crosstalk",
      knows_temperature ? ", with a temperature coefficient" : "");
}

}  // namespace

Table estimator_table(const Evaluation& evaluation) {
  const std::vector<Column> columns = table_columns(evaluation);
  if (columns.empty()) return {};
  Table table{"numbers", groups_of(columns), {"estimator"}, {}};
  for (const Column& column : columns) table.heads.push_back(column.head);
  const std::size_t count = evaluation.estimators.size();
  for (std::size_t i = 0; i < count; ++i) {
    Row row{i, estimator_words(evaluation.estimators[i].name), {}};
    for (const Column& column : columns) {
      const std::optional<double> value = column.value(i);
      const bool is_best = count > 1 && value && value == best_value(column, 0, count);
      row.cells.push_back({value ? column.words(*value) : "-", is_best ? "best" : ""});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<Tile> headline_tiles(const Evaluation& evaluation) {
  std::vector<Tile> tiles;
  for (const Column& column : table_columns(evaluation)) {
    if (column.headline.empty() || !column.value(0)) continue;
    const std::optional<double> other = best_value(column, 1, evaluation.estimators.size());
    tiles.push_back(
        {column.headline, column.words(*column.value(0)), other ? "best other: " + column.words(*other) : ""});
    const JudgedTaxel* const worst = column.headline == kLargestError ? worst_taxel(evaluation) : nullptr;
    if (worst != nullptr) tiles.back().explanation = explain(*worst, evaluation);
  }
  return tiles;
}

void add_estimator_legend(Page& page, const Evaluation& evaluation, const touch::pipeline::Model& model) {
  page.paragraph(
      fmt::format("Relative errors are those of taxels that carry at least {:.3g} N; ghost: force reported on unloaded "
                  "taxels; total: sum over the taxels of one load. Bold: the best of a column. \"No force\": the "
                  "percentile falls on taxels without an estimate, which count as the worst error.",
                  evaluation.judged_from_n),
      "note");
  std::vector<Fact> facts;
  const auto add = [&](const std::string& name, std::string description) {
    facts.emplace_back(estimator_words(name), std::move(description));
  };
  if (!evaluation.estimators.empty()) add(evaluation.estimators.front().name, describe(model));
  for (const touch::fusion::LookUpTables& tables : model.baselines) add(tables.name, describe(tables));
  for (const EstimatorResult& estimator : evaluation.estimators) {
    if (!estimator.description.empty()) add(estimator.name, estimator.description);
  }
  page.facts(facts, "facts note");
}

}  // namespace dermis::out::report
