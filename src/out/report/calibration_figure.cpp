// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "dermis/out/report/estimator_table.hpp"
#include "dermis/out/report/plot.hpp"
#include "dermis/out/report/wording.hpp"
#include "out/report/figures.hpp"

namespace dermis::out::report {
namespace {

constexpr std::size_t kMostLevels = 6;
constexpr std::size_t kMostPointsOfLevel = 64;
constexpr std::size_t kFewestPointsOfLevel = 4;
constexpr std::size_t kMostDots = 2000;
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// A load whose force is known, and what each estimator says.
struct Sample {
  double truth;
  std::vector<double> estimates;
};

using Samples = std::vector<Sample>;
using Levels = std::map<double, Samples>;

/// The judged taxels, or the totals where there are none; loads of zero have no relative error and stay out.
Samples samples_of(const learn::calibration::Evaluation& evaluation) {
  Samples samples;
  for (const auto& taxel : evaluation.taxels) {
    if (taxel.true_newtons > 0.0) samples.push_back({taxel.true_newtons, {taxel.newtons.begin(), taxel.newtons.end()}});
  }
  if (!samples.empty()) return samples;
  for (const auto& total : evaluation.totals) {
    if (total.true_newtons > 0.0) samples.push_back({total.true_newtons, total.newtons});
  }
  return samples;
}

/// The samples by their force, where there are a few levels with some action points each; otherwise nothing.
Levels levels_of(const Samples& samples) {
  Levels levels;
  for (const Sample& sample : samples) {
    Samples& level = levels[sample.truth];
    level.push_back(sample);
    if (levels.size() > kMostLevels || level.size() > kMostPointsOfLevel) return {};
  }
  if (samples.size() < kFewestPointsOfLevel * levels.size()) return {};
  return levels;
}

std::size_t without_force(const Samples& samples, std::size_t estimator) {
  return static_cast<std::size_t>(std::count_if(samples.begin(), samples.end(), [&](const Sample& sample) {
    return !std::isfinite(sample.estimates[estimator]);
  }));
}

/// "raw look-up gives no force for 3 of 48. " for each estimator that leaves some out.
std::string missing_sentences(const learn::calibration::Evaluation& evaluation, const Samples& samples) {
  std::string sentences;
  for (std::size_t i = 0; i < evaluation.estimators.size(); ++i) {
    const std::size_t missing = without_force(samples, i);
    if (missing == 0) continue;
    sentences += fmt::format(" {} gives no force for {} of {}; they are not drawn.",
                             estimator_words(evaluation.estimators[i].name), grouped(missing), grouped(samples.size()));
  }
  return sentences;
}

Axis action_point_axis(std::size_t points) {
  constexpr std::size_t kMostTicks = 16;
  const std::size_t step = (points + kMostTicks - 1) / kMostTicks;
  Axis axis{"action point", Scale::linear, 0.5, static_cast<double>(points) + 0.5, {}};
  for (std::size_t i = 1; i <= points; i += step) axis.ticks.push_back(static_cast<double>(i));
  return axis;
}

Drawing level_panel(const learn::calibration::Evaluation& evaluation, double level, const Samples& samples) {
  std::vector<double> forces = {0.0, level * (1.0 + 2.0 * kPaperTolerance)};
  for (const Sample& sample : samples) forces.insert(forces.end(), sample.estimates.begin(), sample.estimates.end());
  const Axis x = action_point_axis(samples.size());
  Plot plot(fmt::format("{:.4g} N", level), x, nice_axis("output [N]", Scale::linear, forces), 400.0, 330.0);
  const double low = level * (1.0 - kPaperTolerance);
  const double high = level * (1.0 + kPaperTolerance);
  plot.region("calibration \u00b15 %", {{x.low, low}, {x.high, low}, {x.high, high}, {x.low, high}});
  plot.reference("calibration", {{x.low, level}, {x.high, level}});
  for (std::size_t i = 0; i < evaluation.estimators.size(); ++i) {
    std::vector<Point> points;
    for (const Sample& sample : samples) {
      points.push_back({static_cast<double>(points.size() + 1),
                        std::isfinite(sample.estimates[i]) ? sample.estimates[i] : kMissing});
    }
    plot.curve(estimator_words(evaluation.estimators[i].name), i, std::move(points));
  }
  return plot.drawing();
}

double worst_error(const Samples& samples, std::size_t estimator) {
  double worst = 0.0;
  for (const Sample& sample : samples) {
    const double error = std::abs(sample.estimates[estimator] / sample.truth - 1.0);
    if (!std::isfinite(error)) return error;
    worst = std::max(worst, error);
  }
  return worst;
}

/// "Largest relative error at 10, 20, 50 N: dermis 1.2 %, 0.9 %, 2 %; raw look-up ..."
std::string worst_errors_sentence(const learn::calibration::Evaluation& evaluation, const Levels& levels) {
  std::string sentence = "Largest relative error at ";
  for (const auto& [level, samples] : levels) {
    sentence += fmt::format("{}{:.4g}", level == levels.begin()->first ? "" : ", ", level);
  }
  sentence += " N:";
  for (std::size_t i = 0; i < evaluation.estimators.size(); ++i) {
    sentence += (i == 0 ? " " : "; ") + estimator_words(evaluation.estimators[i].name);
    for (const auto& [level, samples] : levels) {
      sentence += (level == levels.begin()->first ? " " : ", ") + percent(worst_error(samples, i));
    }
  }
  return sentence + ".";
}

void draw_levels(const learn::calibration::Evaluation& evaluation, const Levels& levels, Figure& figure) {
  for (const auto& [level, samples] : levels) figure.panels.push_back(level_panel(evaluation, level, samples));
  figure.columns = std::min<std::size_t>(figure.panels.size(), 3);
  figure.caption =
      "Output at each action point against the calibrated load, as in the paper's Fig. 11 to 13; the band is "
      "the 5 % that the paper claims. " +
      worst_errors_sentence(evaluation, levels);
}

/// Forces far below the lightest load are drawn on the lower edge: a logarithmic axis has no zero.
Axis output_axis(const Samples& samples, const std::vector<double>& truths) {
  const double lowest = *std::min_element(truths.begin(), truths.end()) / 20.0;
  std::vector<double> forces = truths;
  for (const Sample& sample : samples) {
    std::copy_if(sample.estimates.begin(), sample.estimates.end(), std::back_inserter(forces),
                 [&](double estimate) { return estimate >= lowest; });
  }
  return nice_axis("output [N]", Scale::logarithmic, forces);
}

bool is_cut_off(const Samples& samples, const Axis& y) {
  return std::any_of(samples.begin(), samples.end(), [&](const Sample& sample) {
    return std::any_of(sample.estimates.begin(), sample.estimates.end(), [&](double force) { return force < y.low; });
  });
}

/// y = x, and the band around it, over the part of the x axis that the y axis covers.
void draw_identity(Plot& plot, const Axis& x, const Axis& y) {
  const double low = std::max(x.low, y.low);
  const double high = std::min(x.high, y.high);
  const double below = 1.0 - kPaperTolerance;
  const double above = 1.0 + kPaperTolerance;
  plot.region("\u00b15 %", {{low, low * below}, {high, high * below}, {high, high * above}, {low, low * above}});
  plot.reference("output = truth", {{low, low}, {high, high}});
}

void draw_scatter(const learn::calibration::Evaluation& evaluation, const Samples& samples, Figure& figure) {
  std::vector<double> truths;
  for (const Sample& sample : samples) truths.push_back(sample.truth);
  const Axis x = nice_axis("true force [N]", Scale::logarithmic, truths);
  const Axis y = output_axis(samples, truths);
  const std::size_t step = (samples.size() + kMostDots - 1) / kMostDots;
  for (std::size_t i = 0; i < evaluation.estimators.size(); ++i) {
    std::vector<Point> points;
    for (std::size_t k = 0; k < samples.size(); k += step) {
      const double estimate = samples[k].estimates[i];
      points.push_back({samples[k].truth, std::isfinite(estimate) ? estimate : kMissing});
    }
    Plot plot(estimator_words(evaluation.estimators[i].name), x, y, 480.0, 380.0);
    draw_identity(plot, x, y);
    plot.cloud("", i, std::move(points));
    figure.panels.push_back(plot.drawing());
  }
  figure.columns = std::min<std::size_t>(figure.panels.size(), 2);
  figure.caption =
      fmt::format("Output of each estimator against the known {}. The band is the 5 % that the paper claims.",
                  evaluation.taxels.empty() ? "totals" : "force of each loaded taxel");
  if (step > 1) figure.caption += fmt::format(" Of {} loads, one in {} is drawn.", grouped(samples.size()), step);
  if (is_cut_off(samples, y)) figure.caption += " Dots on the lower edge lie below it.";
}

}  // namespace

Figure calibration_figure(const learn::calibration::Evaluation& evaluation) {
  Figure figure{"calibration_vs_output.svg", "Calibration against output", "", {}, 1};
  const Samples samples = samples_of(evaluation);
  if (samples.empty() || evaluation.estimators.empty()) {
    figure.caption = "No load above 0 N was judged, so there is no output to compare.";
    return figure;
  }
  if (const Levels levels = levels_of(samples); !levels.empty()) {
    draw_levels(evaluation, levels, figure);
  } else {
    draw_scatter(evaluation, samples, figure);
  }
  figure.caption += missing_sentences(evaluation, samples);
  return figure;
}

}  // namespace dermis::out::report
