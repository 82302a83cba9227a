// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/circuit_trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "learn/calibration/circuit_fit/frame_selection.hpp"
#include "learn/calibration/circuit_fit/gauss_newton.hpp"
#include "learn/calibration/circuit_fit/resolution.hpp"

namespace dermis::learn::calibration {
namespace {

const double kSureSquare = 2.0 * std::log(1000.0);  // odds of a thousand to one distinguish circuits

constexpr double kNearly = 1.1;  // of the misfit that the best circuit leaves
constexpr double kEnough = 0.3;  // a step this small against the standard errors ends a fit

struct Kind {
  const char* name;
  Circuit circuit;
  IdleRows idle_rows;
  IdleColumns idle_columns;
};

constexpr Kind kKinds[] = {
    {"divider, idle rows grounded", Circuit::divider, IdleRows::grounded, IdleColumns::loaded},
    {"divider, idle rows floating", Circuit::divider, IdleRows::floating, IdleColumns::loaded},
    {"divider, idle columns floating", Circuit::divider, IdleRows::grounded, IdleColumns::floating},
    {"transimpedance", Circuit::transimpedance, IdleRows::grounded, IdleColumns::loaded},
    {"flexitac", Circuit::flexitac, IdleRows::grounded, IdleColumns::loaded},
    {"none", Circuit::none, IdleRows::grounded, IdleColumns::loaded},
};

/// `auto` knows at most one value for all drivers and one for all loads.
std::vector<double> for_lines(const std::vector<double>& ohms, std::size_t lines) {
  if (ohms.size() == lines) return ohms;
  return std::vector<double>(lines, ohms.size() == 1 ? ohms.front() : kFitOhm);
}

ArrayDescription as_kind(const ArrayDescription& array, const Kind& kind) {
  ArrayDescription candidate = array;
  Readout& readout = candidate.readout;
  readout.circuit = kind.circuit;
  readout.idle_rows = kind.idle_rows;
  readout.idle_columns = kind.idle_columns;
  if (kind.circuit == Circuit::none) {
    readout.drive_ohm.clear();
    readout.load_ohm.clear();
    return candidate;
  }
  readout.drive_ohm = for_lines(array.readout.drive_ohm, candidate.driven_lines());
  readout.load_ohm = for_lines(array.readout.load_ohm, candidate.sensed_lines());
  return candidate;
}

Scatter lesser(Scatter a, const Scatter& b) {
  a.noise_variance = std::min(a.noise_variance, b.noise_variance);
  a.rubber_variance = std::min(a.rubber_variance, b.rubber_variance);
  return a;
}

JudgedReadings judge(const CommonRatio& fit, const Scatter& scatter, const std::vector<const CircuitFrame*>& frames) {
  return judge_frames(fit.array, fit.rubber, scatter, fit.inverted, frames);
}

using SelectedFrames = std::vector<const CircuitFrame*>;  // of a trial

std::vector<SelectedFrames> select_for_all(std::size_t most, const std::vector<CircuitTrial>& trials) {
  std::vector<SelectedFrames> frames;
  for (const CircuitTrial& trial : trials) frames.push_back(select_frames(*trial.frames, most));
  return frames;
}

/// Judges all by the least scatter among them.
void judge(const std::vector<SelectedFrames>& frames, std::vector<CircuitTrial>& trials) {
  Scatter least;
  least.noise_variance = least.rubber_variance = std::numeric_limits<double>::infinity();
  for (const CircuitTrial& trial : trials) {
    if (trial.fit) least = lesser(least, trial.fit->scatter);
  }
  for (std::size_t k = 0; k < trials.size(); ++k) {
    CircuitTrial& trial = trials[k];
    if (!trial.fit) continue;
    trial.readings = judge(*trial.fit, least, frames[k]);
    trial.misfit = misfit_beside(trial.readings, trial.readings);
  }
}

/// Fits a resistance for each line. Where two circuits explain the frames nearly as well, differences between lines may
/// decide for the wrong one.
Result<CommonRatio> with_lines(const LineParameters& lines, const std::vector<const CircuitFrame*>& frames,
                               const CommonRatio& common) {
  const Result<Iteration> fitted =
      iterate(lines, frames, {lines.start(common.ratio), common.rubber, common.scatter}, kEnough);
  if (!fitted) return fitted.error();
  CommonRatio result;
  result.ratio = common.ratio;
  result.array = lines.array_at(fitted->estimate.parameters);
  Result<InvertedFrames> inverted = invert_frames(result.array, frames);
  if (!inverted) return inverted.error();
  result.inverted = *std::move(inverted);
  const Iteration laws = fit_laws(LineParameters(result.array), result.inverted, frames,
                                  {{}, fitted->estimate.rubber, fitted->estimate.scatter});
  result.rubber = laws.estimate.rubber;
  result.scatter = laws.estimate.scatter;
  return result;
}

/// Empty where the residual is larger than before: the fit has lost its way.
std::optional<CommonRatio> refit(const std::vector<const CircuitFrame*>& frames, const CircuitTrial& trial) {
  Result<CommonRatio> refit = with_lines(LineParameters(trial.array), frames, *trial.fit);
  if (!refit) return std::nullopt;
  const Scatter scatter = lesser(refit->scatter, trial.fit->scatter);
  const double before = misfit_of(judge(*trial.fit, scatter, frames)).square;
  if (misfit_of(judge(*refit, scatter, frames)).square > before) return std::nullopt;
  return *std::move(refit);
}

/// Fits all circuits that are near the best one, where there are several; only then do they compare.
void fit_lines_of_rivals(const std::vector<SelectedFrames>& frames, std::vector<CircuitTrial>& trials) {
  double least = std::numeric_limits<double>::infinity();
  const auto is_circuit = [](const CircuitTrial& trial) {
    return trial.fit && trial.array.readout.circuit != Circuit::none;
  };
  for (const CircuitTrial& trial : trials) {
    if (is_circuit(trial)) least = std::min(least, trial.misfit.square);
  }
  std::vector<std::size_t> near;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    if (is_circuit(trials[k]) && trials[k].misfit.square <= kNearly * least) near.push_back(k);
  }
  if (near.size() < 2) return;
  std::vector<std::optional<CommonRatio>> refits;
  for (const std::size_t k : near) refits.push_back(refit(frames[k], trials[k]));
  const bool all_fitted = std::all_of(refits.begin(), refits.end(), [](const auto& fit) { return fit.has_value(); });
  for (std::size_t k = 0; k < near.size(); ++k) {
    trials[near[k]].is_rough = !all_fitted;
    if (all_fitted) trials[near[k]].fit = std::move(refits[k]);
  }
  judge(frames, trials);
}

}  // namespace

std::vector<CircuitTrial> trials_of_all_kinds(const ArrayDescription& array, const CircuitFrames& frames) {
  std::vector<CircuitTrial> trials;
  for (const Kind& kind : kKinds) {
    trials.push_back({.name = kind.name, .array = as_kind(array, kind), .frames = &frames});
  }
  return trials;
}

ArrayDescription without_circuit(const ArrayDescription& array) {
  return as_kind(array, *std::find_if(std::begin(kKinds), std::end(kKinds),
                                      [](const Kind& kind) { return kind.circuit == Circuit::none; }));
}

void fit_trials(std::size_t most, std::vector<CircuitTrial>& trials) {
  const std::vector<SelectedFrames> frames = select_for_all(most, trials);
  parallel_for(trials.size(), [&](std::size_t k) {
    const LineParameters lines(trials[k].array);
    const CircuitFrames& all = *trials[k].frames;
    trials[k] = {.name = trials[k].name,
                 .array = lines.array(),
                 .frames = &all,
                 .noise_share = unresolved_share(lines.array(), all)};
    if (trials[k].noise_share > 0.0) return;
    const Rubber unknown = unknown_rubber(all, lines.array().taxel_count(), 1.0 / lines.reference_ohm());
    Result<CommonRatio> fit = fit_common_ratio(lines, frames[k], unknown);
    if (fit) trials[k].fit = *std::move(fit);
  });
  judge(frames, trials);
}

void fit_trials_and_lines(std::size_t most, std::vector<CircuitTrial>& trials) {
  fit_trials(most, trials);
  fit_lines_of_rivals(select_for_all(most, trials), trials);
}

double sure_square(const FrameMisfit& best) {
  return kSureSquare * std::max(1.0, best.square / best.readings);
}

TrialComparison compare(const CircuitTrial& first, const CircuitTrial& second) {
  if (!first.fit || !second.fit) return {first.misfit, second.misfit};  // infinite where it cannot give the frames
  if (!first.is_rough && !second.is_rough) {
    return {misfit_beside(first.readings, second.readings), misfit_beside(second.readings, first.readings)};
  }
  const std::size_t taxels = first.fit->array.taxel_count();
  return {rough_misfit_beside(first.readings, second.readings, taxels),
          rough_misfit_beside(second.readings, first.readings, taxels)};
}

bool has_less(const CircuitTrial& a, const CircuitTrial& b) {
  const TrialComparison both = compare(a, b);
  return both.first.square < both.second.square;
}

bool is_surely_less(const CircuitTrial& better, const CircuitTrial& worse) {
  constexpr double kMargin = 10.0;
  const TrialComparison both = compare(better, worse);
  const double margin = better.is_rough && worse.is_rough ? kMargin : 1.0;
  return both.first.square + margin * sure_square(both.first) < both.second.square;
}

bool is_refuted(const CircuitTrial& worse, const CircuitTrial& better) {
  if (!better.fit) return false;
  const TrialComparison both = compare(better, worse);
  const auto terms = static_cast<double>(kPressedTerms * static_cast<Eigen::Index>(better.fit->rubber.laws.size()));
  const double scale = std::max(1.0, both.first.square / both.first.readings);
  return both.first.square + (kSureSquare + terms) * scale < both.second.square;
}

}  // namespace dermis::learn::calibration
