// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/recognition_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "dermis/out/report/files.hpp"
#include "dermis/out/report/heat_map.hpp"
#include "dermis/out/report/page.hpp"
#include "dermis/out/report/wording.hpp"

namespace dermis::out::report {
namespace {

using learn::recognition::EstimatorFigures;
using learn::recognition::Judgement;
using learn::recognition::LabelledFrames;
using learn::recognition::Learned;

constexpr std::size_t kWidestTable = 16;  // classes
constexpr std::size_t kMostErrors = 8;
constexpr std::size_t kPanelColumns = 4;
constexpr const char* kHowToRead =
    "All learn from the same examples, are asked the same ones and see the same folds; dermis is the recipe of "
    "docs/reasons/recognition.md, and what learning writes. The nearest frame compares what is held, taxel by taxel, "
    "and "
    "gives no probability.";

std::string share(double value) {
  return fmt::format("{:.1f} %", 100.0 * value);
}

std::string folds_of(const Learned& learned) {
  return fmt::format("{} folds {}", learned.report.folds,
                     learned.report.by_group ? "of whole recordings, subjects or sessions" : "in order of time");
}

void add_summary(Page& page, const Learned& learned) {
  const learn::recognition::LearningReport& report = learned.report;
  page.tiles({{"accuracy", share(report.accuracy), "cross-validated, " + folds_of(learned)},
              {"calibration error", share(report.calibration_error), "of the probabilities"},
              {"examples", grouped(report.judged), fmt::format("of {} classes", learned.classes.names.size())}});
  for (const std::string& line : learn::recognition::advice(learned)) page.paragraph(line, "note");
}

void add_estimators(Page& page, std::span<const EstimatorFigures> estimators) {
  page.heading("Estimators side by side");
  double best = 0.0;
  double least_error = 1.0;
  for (const EstimatorFigures& estimator : estimators) {
    best = std::max(best, estimator.accuracy);
    least_error = std::min(least_error, estimator.calibration_error.value_or(1.0));
  }
  Table table{
      .style = "numbers compact", .groups = {}, .heads = {"estimator", "accuracy", "calibration error"}, .rows = {}};
  for (const EstimatorFigures& estimator : estimators) {
    const auto& error = estimator.calibration_error;
    table.rows.push_back({std::nullopt,
                          estimator.name,
                          {{share(estimator.accuracy), estimator.accuracy == best ? "best" : ""},
                           {error ? share(*error) : "-", error == least_error ? "best" : ""}}});
  }
  page.table(table);
  page.paragraph(kHowToRead, "muted");
}

void add_confusion_table(Page& page, const Learned& learned) {
  const std::vector<std::string>& names = learned.classes.names;
  page.heading("Confusion");
  if (names.size() > kWidestTable) return;
  Table table{.style = "numbers dense", .groups = {}, .heads = {"right class"}, .rows = {}};
  for (const std::string& name : names) table.heads.push_back(name);
  for (std::size_t row = 0; row < names.size(); ++row) {
    Row cells{std::nullopt, names[row], {}};
    for (std::size_t col = 0; col < names.size(); ++col) {
      const std::size_t count = learned.report.confusion[row * names.size() + col];
      cells.cells.push_back({count == 0 ? "" : grouped(count), row == col ? "best" : ""});
    }
    table.rows.push_back(std::move(cells));
  }
  page.table(table);
}

Figure confusion_figure(const Learned& learned) {
  const std::size_t count = learned.classes.names.size();
  HeatMap map;
  map.title = "share of the right class [%]";
  map.rows = map.cols = count;
  map.high = 100.0;
  map.values.assign(count * count, 0.0);
  for (std::size_t row = 0; row < count; ++row) {
    std::size_t sum = 0;
    for (std::size_t col = 0; col < count; ++col) sum += learned.report.confusion[row * count + col];
    for (std::size_t col = 0; col < count; ++col) {
      map.values[row * count + col] = 100.0 * static_cast<double>(learned.report.confusion[row * count + col]) /
                                      static_cast<double>(std::max<std::size_t>(sum, 1));
    }
  }
  return {"confusion.svg",
          "What is answered",
          "Rows are the right classes, columns the answers, both in the order of the alphabet.",
          {heat_map(map)},
          1};
}

/// The surest of the wrong answers first.
std::vector<Judgement> worst_errors(const Learned& learned) {
  std::vector<Judgement> errors;
  for (const Judgement& judgement : learned.report.judgements) {
    if (judgement.answer != judgement.truth) errors.push_back(judgement);
  }
  std::stable_sort(errors.begin(), errors.end(),
                   [](const Judgement& a, const Judgement& b) { return a.probability > b.probability; });
  if (errors.size() > kMostErrors) errors.resize(kMostErrors);
  return errors;
}

std::vector<Drawing> panels_of(const LabelledFrames& data, const learn::recognition::Label& label) {
  const std::vector<float> image = held_image(data, label);
  std::vector<Drawing> panels;
  for (const learn::recognition::SensedArray& array : data.layout.arrays) {
    HeatMap map;
    map.title = array.name + (data.layout.has_forces() ? ": force [N]" : ": load");
    map.rows = array.rows;
    map.cols = array.cols;
    if (array.has_pitch()) {
      map.row_pitch = array.row_pitch_mm;
      map.col_pitch = array.col_pitch_mm;
    }
    const auto first = image.begin() + static_cast<std::ptrdiff_t>(array.first_column);
    map.values.assign(first, first + static_cast<std::ptrdiff_t>(array.taxel_count()));
    map.high = heat_map_high(map.values);
    panels.push_back(heat_map(map));
  }
  return panels;
}

std::vector<Figure> error_figures(const LabelledFrames& data, const Learned& learned) {
  std::vector<Figure> figures;
  for (const Judgement& error : worst_errors(learned)) {
    const learn::recognition::Label& label = data.labels[error.example];
    const std::vector<std::string>& names = learned.classes.names;
    figures.push_back({fmt::format("error_{}.svg", figures.size() + 1),
                       fmt::format("{} is {}, not {}", label.id, names[error.truth], names[error.answer]),
                       fmt::format("The probability of {} was {}. The picture is the mean of what is held.",
                                   names[error.answer], share(error.probability)),
                       panels_of(data, label), kPanelColumns});
  }
  return figures;
}

std::string page_of(const Learned& learned, std::span<const EstimatorFigures> estimators, const Figure& confusion,
                    const std::vector<Figure>& errors) {
  Page page("recognition", "What is recognised, and what is confused");
  add_summary(page, learned);
  add_estimators(page, estimators);
  add_confusion_table(page, learned);
  page.figure(confusion);
  page.heading("The worst errors");
  page.paragraph(errors.empty() ? "No example was answered wrongly." : "The wrong answers that were surest.", "muted");
  if (!errors.empty()) page.figures(errors);
  return std::move(page).html();
}

}  // namespace

std::string recognition_page(const LabelledFrames& data, const Learned& learned,
                             std::span<const EstimatorFigures> estimators) {
  return page_of(learned, estimators, confusion_figure(learned), error_figures(data, learned));
}

Status write_recognition_report(const std::string& directory, const LabelledFrames& data, const Learned& learned,
                                std::span<const EstimatorFigures> estimators) {
  std::vector<Figure> figures = error_figures(data, learned);
  const Figure confusion = confusion_figure(learned);
  const std::string page = page_of(learned, estimators, confusion, figures);
  figures.push_back(confusion);
  return write_files(directory, figures, page);
}

}  // namespace dermis::out::report
