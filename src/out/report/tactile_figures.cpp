// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/format.h>

#include <cmath>

#include "dermis/out/report/wording.hpp"
#include "out/report/figures.hpp"
#include "out/report/tactile_image.hpp"

namespace dermis::out::report {
namespace {

template <typename Values>
double finite_sum(const Values& values) {
  double sum = 0.0;
  for (const double value : values) sum += std::isfinite(value) ? value : 0.0;
  return sum;
}

Figure tactile_figure(const ArrayDescription& array, const learn::calibration::TactileExample& example,
                      std::size_t number) {
  return {fmt::format("tactile_{}.svg", number), fmt::format("Tactile image of frame {}", example.frame),
          fmt::format("Together {} of a true {}. Every square is one measured taxel; both forces share one scale; "
                      "crossed-out taxels have no force.",
                      newtons(finite_sum(example.newtons)), newtons(finite_sum(example.true_newtons))),
          tactile_panels(array, example), 4};
}

}  // namespace

std::vector<Figure> tactile_figures(const learn::calibration::Evaluation& evaluation) {
  std::vector<Figure> figures;
  for (const auto& example : evaluation.examples) {
    figures.push_back(tactile_figure(evaluation.array, example, figures.size() + 1));
  }
  if (figures.empty()) {
    figures.push_back({"",
                       "Tactile images",
                       "No loaded frame has a known force on every taxel, so there is no true "
                       "image to compare with.",
                       {},
                       1});
  }
  return figures;
}

}  // namespace dermis::out::report
