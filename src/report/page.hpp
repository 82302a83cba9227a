// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dermis/calibration/evaluation.hpp"
#include "dermis/core/array_description.hpp"
#include "dermis/pipeline/model.hpp"
#include "report/figures.hpp"

namespace dermis::report {

/// The page of an evaluation, written from top to bottom. Well-formed as XML, too.
class Page {
 public:
  explicit Page(const std::string& array_name);

  /// The result of the first estimator in large numbers, and what it was judged on.
  void add_summary(const calibration::Evaluation& evaluation);
  /// The table of all estimators, and what each of them is.
  void add_estimators(const calibration::Evaluation& evaluation, const pipeline::Model& model);
  void add_figure(const Figure& figure);
  /// Figures of one size, beside each other where there is room.
  void add_figures(const std::vector<Figure>& figures);
  void add_array(const ArrayDescription& array);
  void add_provenance(const pipeline::Model& model);

  [[nodiscard]] std::string html() &&;

 private:
  void add_legend(const calibration::Evaluation& evaluation, const pipeline::Model& model);
  void element(std::string_view tag, std::string_view style, std::string_view words);
  void tile(std::string_view name, std::string_view value, std::string_view note);
  void row(std::string_view name, std::string_view value);

  std::string html_;
  std::size_t figures_ = 0;
};

}  // namespace dermis::report
