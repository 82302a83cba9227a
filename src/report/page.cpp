// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "report/canvas.hpp"
#include "report/wording.hpp"

namespace dermis::report {
namespace {

using calibration::EstimatorResult;
using calibration::Evaluation;

constexpr std::string_view kPageCss =
    ":root{color-scheme:light dark}\n"
    "*{box-sizing:border-box}\n"
    "body{margin:0;background:#fff;color:#1c2128;font:16px/1.5 system-ui,\"Segoe UI\",Helvetica,Arial,"
    "\"Liberation Sans\",sans-serif}\n"
    "main{max-width:1180px;margin:0 auto;padding:32px 20px 48px}\n"
    "h1{font-size:1.7rem;line-height:1.2;margin:0 0 4px;font-weight:650;overflow-wrap:anywhere}\n"
    "h2{font-size:1.15rem;margin:44px 0 10px;padding-top:12px;border-top:1px solid #d5dae0;font-weight:650}\n"
    "p{margin:8px 0;max-width:78ch}\n"
    ".muted,figcaption,.note{color:#59636e}\n"
    ".tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(150px,1fr));margin:24px 1px 8px 0}\n"
    ".tile{border:1px solid #d5dae0;margin:0 -1px -1px 0;padding:12px 14px}\n"
    ".tile b{display:block;font-size:1.75rem;line-height:1.25;font-weight:600;font-variant-numeric:tabular-nums;"
    "white-space:nowrap}\n"
    ".tile span{display:block;font-size:.82rem;color:#59636e;overflow-wrap:anywhere}\n"
    ".scroll{overflow-x:auto}\n"
    "table{border-collapse:collapse;font-size:.9rem;font-variant-numeric:tabular-nums}\n"
    "th,td{padding:6px 12px 6px 0;text-align:left;vertical-align:top;border-bottom:1px solid #e3e7ec}\n"
    "thead th{vertical-align:bottom;border-bottom:1px solid #59636e;font-weight:600}\n"
    "tbody th{font-weight:500}\n"
    ".numbers{width:100%}\n"
    ".numbers th+th,.numbers td{text-align:right;white-space:nowrap;padding:6px 0 6px 14px}\n"
    ".numbers tbody th{white-space:nowrap}\n"
    ".numbers svg{width:12px;height:12px;margin-right:6px;vertical-align:-1px;display:inline}\n"
    ".numbers .group{text-align:center;border-bottom:1px solid #e3e7ec;font-weight:400;color:#59636e}.numbers thead "
    "td{border:0}\n"
    ".best{font-weight:700}\n"
    ".facts th{width:16rem;padding-right:20px;overflow-wrap:anywhere}\n"
    ".facts td{overflow-wrap:anywhere}\n"
    ".note{font-size:.86rem}\n"
    "figure{margin:28px 0 0;break-inside:avoid}\n"
    "figcaption{font-size:.9rem;max-width:84ch;margin-top:6px;overflow-wrap:anywhere}\n"
    "figcaption b{color:#1c2128}\n"
    ".panels{display:grid;gap:12px 20px}\n"
    ".panels .fig{display:block;width:100%;height:auto}\n"
    ".across1{max-width:560px}\n"
    ".across2{grid-template-columns:repeat(2,minmax(0,1fr))}\n"
    ".across3{grid-template-columns:repeat(3,minmax(0,1fr))}\n"
    ".across4{grid-template-columns:repeat(4,minmax(0,1fr))}\n"
    "@media (max-width:820px){.across2,.across3{grid-template-columns:minmax(0,1fr)}"
    ".across4{grid-template-columns:repeat(2,minmax(0,1fr))}}\n"
    "@media (max-width:480px){main{padding:20px 14px 36px}.facts th{width:11rem}.tiles{grid-template-columns:1fr "
    "1fr}}\n"
    "@media screen and (prefers-color-scheme:dark){\n"
    "body{background:#14181d;color:#e6eaf0}\n"
    "h2,.tile{border-color:#39424d}\n"
    "th,td{border-color:#2b323b}thead th{border-color:#8b96a3}.numbers .group{border-color:#2b323b}\n"
    ".muted,figcaption,.note,.tile span,.numbers .group{color:#9aa5b1}figcaption b{color:#e6eaf0}\n"
    "}\n"
    "@media print{main{max-width:none;padding:0}body{font-size:11pt}h2{break-after:avoid}.scroll{overflow:visible}}\n";

/// One column of the table of estimators: the smaller the better, except for shares.
struct Column {
  std::string group;  ///< Stands above neighbouring columns.
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

/// Two rows: the groups, and the columns in them.
std::string table_heads(const std::vector<Column>& columns) {
  std::string groups;
  std::string heads;
  for (std::size_t i = 0; i < columns.size();) {
    const std::size_t first = i;
    while (i < columns.size() && columns[i].group == columns[first].group)
      heads += "<th>" + columns[i++].head + "</th>";
    groups += fmt::format("<th class=\"group\" colspan=\"{}\">{}</th>", i - first, columns[first].group);
  }
  return "<tr><td></td>" + groups + "</tr>\n<tr><th>estimator</th>" + heads + "</tr>\n";
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

std::string series_key(std::size_t style) {
  return fmt::format(
      "<svg class=\"fig\" viewBox=\"0 0 12 12\" width=\"12\" height=\"12\" aria-hidden=\"true\"><g "
      "class=\"{}\"><path class=\"mark\" d=\"{}\"/></g></svg>",
      series_class(style), mark(style, {6.0, 6.0}));
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

Page::Page(const std::string& array_name) {
  const std::string name = escape_xml(array_name);
  html_ = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n"
      "<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>{0}: force evaluation</title>\n<style>\n{1}{2}</style>\n</head>\n<body>\n<main>\n"
      "<h1>{0}: force against known loads</h1>\n",
      name, figure_css(), kPageCss);
}

void Page::add_summary(const Evaluation& evaluation) {
  if (evaluation.estimators.empty()) {
    element("p", "", "No estimator was judged.");
    return;
  }
  element("p", "muted", summary_sentence(evaluation));
  html_ += "<div class=\"tiles\">\n";
  for (const Column& column : table_columns(evaluation)) {
    if (column.headline.empty() || !column.value(0)) continue;
    const std::optional<double> other = best_value(column, 1, evaluation.estimators.size());
    tile(column.headline, column.words(*column.value(0)), other ? "best other: " + column.words(*other) : "");
  }
  html_ += "</div>\n";
}

void Page::tile(std::string_view name, std::string_view value, std::string_view note) {
  html_ += "<div class=\"tile\">";
  element("span", "", name);
  element("b", "", value);
  element("span", "", note);
  html_ += "</div>\n";
}

void Page::add_estimators(const Evaluation& evaluation, const pipeline::Model& model) {
  const std::vector<Column> columns = table_columns(evaluation);
  if (columns.empty()) return;
  element("h2", "", "Estimators side by side");
  html_ += "<div class=\"scroll\"><table class=\"numbers\">\n<thead>\n";
  html_ += table_heads(columns) + "</thead>\n<tbody>\n";
  const std::size_t count = evaluation.estimators.size();
  for (std::size_t i = 0; i < evaluation.estimators.size(); ++i) {
    html_ += "<tr><th>" + series_key(i) + escape_xml(evaluation.estimators[i].name) + "</th>";
    for (const Column& column : columns) {
      const std::optional<double> value = column.value(i);
      const bool is_best = count > 1 && value && value == best_value(column, 0, count);
      element("td", is_best ? "best" : "", value ? column.words(*value) : "-");
    }
    html_ += "</tr>\n";
  }
  html_ += "</tbody></table></div>\n";
  add_legend(evaluation, model);
  element("h2", "", "Figures");
}

void Page::add_legend(const Evaluation& evaluation, const pipeline::Model& model) {
  element("p", "note",
          "Relative errors are those of taxels that carry at least 1 N; ghost: force reported on unloaded "
          "taxels; total: sum over the taxels of one load. Bold: the best of a column. \"No force\": the "
          "percentile falls on taxels without an estimate, which count as the worst error.");
  html_ += "<table class=\"facts note\"><tbody>\n";
  if (!evaluation.estimators.empty()) row(evaluation.estimators.front().name, describe(model));
  for (const fusion::LookUpTables& tables : model.baselines) row(tables.name, describe(tables));
  html_ += "</tbody></table>\n";
}

void Page::add_figure(const Figure& figure) {
  html_ += "<figure>\n";
  if (!figure.panels.empty()) {
    html_ += fmt::format("<div class=\"panels across{}\">\n", figure.columns);
    for (const Drawing& panel : figure.panels) html_ += svg_element(panel);
    html_ += "</div>\n";
  }
  html_ += fmt::format("<figcaption><b>Fig. {}. {}.</b> {}</figcaption>\n</figure>\n", ++figures_,
                       escape_xml(figure.title), escape_xml(figure.caption));
}

void Page::add_figures(const std::vector<Figure>& figures) {
  html_ += "<div class=\"panels across2\">\n";
  for (const Figure& figure : figures) add_figure(figure);
  html_ += "</div>\n";
}

void Page::add_array(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  element("h2", "", "Array");
  html_ += "<table class=\"facts\"><tbody>\n";
  row("name", array.name);
  row("taxels", fmt::format("{} rows x {} columns", array.rows, array.cols));
  row("pitch", fmt::format("{:.4g} mm x {:.4g} mm", 1e3 * array.row_pitch_m, 1e3 * array.col_pitch_m));
  if (array.taxel_area_m2) row("pressed area of a taxel", fmt::format("{:.4g} mm2", 1e6 * *array.taxel_area_m2));
  row("circuit", to_string(readout.circuit));
  if (readout.circuit != Circuit::none) row("idle rows", to_string(readout.idle_rows));
  if (!readout.drive_ohm.empty()) row("drive", resistances(readout.drive_ohm));
  if (!readout.load_ohm.empty()) row("load", resistances(readout.load_ohm));
  row("ADC", fmt::format("{} bit", readout.adc_bits));
  if (readout.supply_v) row("nominal supply", fmt::format("{:.4g} V", *readout.supply_v));
  html_ += "</tbody></table>\n";
}

void Page::add_provenance(const pipeline::Model& model) {
  element("h2", "", "Provenance of the model");
  if (model.provenance.empty()) {
    element("p", "", "The model says nothing about its calibration.");
    return;
  }
  html_ += "<table class=\"facts\"><tbody>\n";
  for (const auto& [key, value] : model.provenance) row(key, value);
  html_ += "</tbody></table>\n";
}

void Page::element(std::string_view tag, std::string_view style, std::string_view words) {
  const std::string attribute = style.empty() ? "" : fmt::format(" class=\"{}\"", style);
  fmt::format_to(std::back_inserter(html_), "<{0}{1}>{2}</{0}>", tag, attribute, escape_xml(words));
}

void Page::row(std::string_view name, std::string_view value) {
  html_ += "<tr>";
  element("th", "", name);
  element("td", "", value);
  html_ += "</tr>\n";
}

std::string Page::html() && {
  html_ += "</main>\n</body>\n</html>\n";
  return std::move(html_);
}

}  // namespace dermis::report
