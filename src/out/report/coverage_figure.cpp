// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "dermis/out/report/plot.hpp"
#include "dermis/out/report/wording.hpp"
#include "out/report/figures.hpp"

namespace dermis::out::report {
namespace {

using learn::calibration::Evaluation;
using learn::calibration::JudgedTaxel;

constexpr double kLargestSigma = 3.0;
constexpr int kSteps = 60;
constexpr double kWidth = 440.0;
constexpr double kHeight = 400.0;
constexpr std::size_t kMarks = 7;

/// Probability [%] that a normal error is within so many standard deviations.
double nominal_percent(double sigmas) {
  return 100.0 * std::erf(sigmas / std::numbers::sqrt2);
}

std::vector<Point> reliability(const std::vector<JudgedTaxel>& taxels) {
  std::vector<double> sigmas;
  for (int step = 0; step <= kSteps; ++step) sigmas.push_back(kLargestSigma * step / kSteps);
  const std::vector<double> shares = learn::calibration::covered_shares(taxels, sigmas);
  std::vector<Point> points;
  for (std::size_t k = 0; k < shares.size(); ++k) points.push_back({nominal_percent(sigmas[k]), 100.0 * shares[k]});
  return points;
}

/// Which errors the bound is compared with, and why others on the page may be below it.
std::string bound_sentences(const Evaluation& evaluation) {
  const learn::calibration::BoundComparison& bound = evaluation.bound;
  std::string words = fmt::format(
      " Under the noise of the ADC alone no unbiased estimator scatters less than the Cramer-Rao bound: {:.2f} % of "
      "the force (median of {} taxels of {}); dermis scatters by {:.2f} % on them, and the root mean square of its "
      "error over the bound is {:.2f}.",
      100.0 * bound.median_bound, grouped(bound.taxels), counted(bound.frames, "frame"), 100.0 * bound.median_deviation,
      bound.rms_ratio);
  const std::optional<double> median = evaluation.estimators.front().relative_error.median;
  if (median && *median < bound.median_bound) {
    words += fmt::format(
        " The median error of {} above is lower than the bound because it is another quantity of other taxels: it is "
        "of all {}, not of these {}, and half of all errors are below 0.67 standard deviations.",
        percent(*median), grouped(evaluation.taxels.size()), grouped(bound.taxels));
  }
  if (bound.median_deviation < bound.median_bound) {
    words +=
        " It scatters less than the bound where its networks, which are smooth, give the usual force: it is not "
        "unbiased.";
  }
  return words;
}

Axis percent_axis(std::string label) {
  return {std::move(label), Scale::linear, 0.0, 100.0, {0, 20, 40, 60, 80, 100}};
}

}  // namespace

Figure coverage_figure(const Evaluation& evaluation) {
  Figure figure{"coverage.svg", "How sure dermis is, and how often it is right", "", {}};
  if (evaluation.coverage.count == 0) {
    figure.caption = fmt::format("No taxel with a known force of at least {:.3g} N has a standard deviation.",
                                 evaluation.judged_from_n);
    return figure;
  }
  Plot plot("", percent_axis("interval that dermis gives [%]"), percent_axis("true forces within it [%]"), kWidth,
            kHeight);
  plot.reference("right", {{0.0, 0.0}, {100.0, 100.0}});
  plot.line("dermis", 0, reliability(evaluation.taxels), kMarks);
  figure.panels.push_back(plot.drawing());
  figure.caption = fmt::format(
      "The true force of {} taxels is within the 68 % interval of dermis in {:.1f} % and within the 95 % interval in "
      "{:.1f} %. Below the straight line dermis is too sure, above it too modest. Taxels of which only a lower bound "
      "is known (saturated, or beyond eight times the heaviest calibrated load) are not counted.",
      grouped(evaluation.coverage.count), 100.0 * *evaluation.coverage.share_68, 100.0 * *evaluation.coverage.share_95);
  if (evaluation.bound.frames > 0) figure.caption += bound_sentences(evaluation);
  return figure;
}

}  // namespace dermis::out::report
