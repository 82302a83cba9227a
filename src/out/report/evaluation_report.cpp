// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/evaluation_report.hpp"

#include <utility>
#include <vector>

#include "dermis/out/report/files.hpp"
#include "dermis/out/report/page.hpp"
#include "out/report/evaluation_sections.hpp"
#include "out/report/figures.hpp"

namespace dermis::out::report {
namespace {

struct Figures {
  Figure calibration;
  std::vector<Figure> breakdowns;
  Figure touch;
  Figure coverage;
  std::vector<Figure> tactile;
};

Figures all_figures(const learn::calibration::Evaluation& evaluation) {
  return {calibration_figure(evaluation), breakdown_figures(evaluation), touch_figure(evaluation),
          coverage_figure(evaluation), tactile_figures(evaluation)};
}

std::string page_of(const learn::calibration::Evaluation& evaluation, const touch::pipeline::Model& model,
                    const Origin& origin, const Figures& figures) {
  const std::string name = evaluation.array.name.empty() ? "array" : evaluation.array.name;
  Page page(name + ": force evaluation", name + ": force against known loads");
  if (!origin.summary.empty()) page.paragraph(origin.summary);
  add_summary(page, evaluation);
  add_estimators(page, evaluation, model);
  page.figure(figures.calibration);
  page.figures(figures.breakdowns);
  page.figure(figures.touch);
  page.figure(figures.coverage);
  for (const Figure& figure : figures.tactile) page.figure(figure);
  add_array(page, evaluation.array);
  add_origin(page, origin);
  add_provenance(page, model);
  return std::move(page).html();
}

}  // namespace

std::string evaluation_page(const learn::calibration::Evaluation& evaluation, const touch::pipeline::Model& model,
                            const Origin& origin) {
  return page_of(evaluation, model, origin, all_figures(evaluation));
}

Status write_evaluation_report(const std::string& directory, const learn::calibration::Evaluation& evaluation,
                               const touch::pipeline::Model& model, const Origin& origin) {
  const Figures figures = all_figures(evaluation);
  std::vector<Figure> files = {figures.calibration};
  files.insert(files.end(), figures.breakdowns.begin(), figures.breakdowns.end());
  files.push_back(figures.touch);
  files.push_back(figures.coverage);
  files.insert(files.end(), figures.tactile.begin(), figures.tactile.end());
  return write_files(directory, files, page_of(evaluation, model, origin, figures));
}

}  // namespace dermis::out::report
