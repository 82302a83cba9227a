// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/report/evaluation_report.hpp"

#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "dermis/store/atomic_file.hpp"
#include "report/figures.hpp"
#include "report/page.hpp"

namespace dermis::report {
namespace {

struct Figures {
  Figure calibration;
  std::vector<Figure> breakdowns;
  std::vector<Figure> tactile;
};

Figures all_figures(const calibration::Evaluation& evaluation) {
  return {calibration_figure(evaluation), breakdown_figures(evaluation), tactile_figures(evaluation)};
}

std::string page_of(const calibration::Evaluation& evaluation, const pipeline::Model& model, const Figures& figures) {
  Page page(evaluation.array.name.empty() ? "array" : evaluation.array.name);
  page.add_summary(evaluation);
  page.add_estimators(evaluation, model);
  page.add_figure(figures.calibration);
  page.add_figures(figures.breakdowns);
  for (const Figure& figure : figures.tactile) page.add_figure(figure);
  page.add_array(evaluation.array);
  page.add_provenance(model);
  return std::move(page).html();
}

Status write_file(const std::filesystem::path& path, const std::string& text) {
  Result<store::AtomicFile> file = store::AtomicFile::create(path.string());
  if (!file) return file.error();
  file->write(text);
  return file->commit();
}

Status write_figures(const std::filesystem::path& directory, const std::vector<Figure>& figures) {
  for (const Figure& figure : figures) {
    if (figure.panels.empty()) continue;
    const Drawing sheet = side_by_side(figure.panels, figure.columns);
    if (Status written = write_file(directory / figure.file, svg_document(sheet)); !written) return written;
  }
  return Done{};
}

}  // namespace

std::string evaluation_page(const calibration::Evaluation& evaluation, const pipeline::Model& model) {
  return page_of(evaluation, model, all_figures(evaluation));
}

Status write_evaluation_report(const std::string& directory, const calibration::Evaluation& evaluation,
                               const pipeline::Model& model) {
  const Figures figures = all_figures(evaluation);
  const std::string page = page_of(evaluation, model, figures);
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) return failed("cannot make the directory '" + directory + "': " + error.message());
  if (Status written = write_figures(directory, {figures.calibration}); !written) return written;
  if (Status written = write_figures(directory, figures.breakdowns); !written) return written;
  if (Status written = write_figures(directory, figures.tactile); !written) return written;
  return write_file(std::filesystem::path(directory) / "index.html", page);
}

}  // namespace dermis::report
