// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/circuit_fit/circuit_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "calibration/circuit_fit/common_ratio.hpp"
#include "calibration/circuit_fit/frame_selection.hpp"
#include "calibration/circuit_fit/gauss_newton.hpp"
#include "calibration/circuit_fit/judge_frames.hpp"
#include "calibration/circuit_fit/resolution.hpp"
#include "calibration/circuit_fit/telling_presses.hpp"
#include "dermis/calibration/parallel.hpp"

namespace dermis::calibration {
namespace {

const double kSureSquare = 2.0 * std::log(1000.0);  // odds of a thousand to one tell one circuit from another

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

/// What a kind makes of the frames.
struct Trial {
  const Kind* kind = nullptr;
  std::optional<CommonRatio> fit = {};  // empty: it cannot give them, or is not resolved
  double noise_share = 0.0;             // 0: it is resolved
  bool is_rough = false;                // what its lines differ by could not be compared
  JudgedReadings readings = {};
  FrameMisfit misfit = {std::numeric_limits<double>::infinity(), 0.0};  // of the readings that tell
};

std::vector<Trial> all_kinds() {
  std::vector<Trial> trials;
  for (const Kind& kind : kKinds) trials.push_back({.kind = &kind});
  return trials;
}

Scatter lesser(Scatter a, const Scatter& b) {
  a.noise_variance = std::min(a.noise_variance, b.noise_variance);
  a.rubber_variance = std::min(a.rubber_variance, b.rubber_variance);
  return a;
}

JudgedReadings judge(const CommonRatio& fit, const Scatter& scatter, const std::vector<const CircuitFrame*>& frames) {
  return judge_frames(fit.array, fit.rubber, scatter, fit.inverted, frames);
}

/// All by the least scatter that one of them leaves.
void judge(std::vector<Trial>& trials, const std::vector<const CircuitFrame*>& frames) {
  Scatter least;
  least.noise_variance = least.rubber_variance = std::numeric_limits<double>::infinity();
  for (const Trial& trial : trials) {
    if (trial.fit) least = lesser(least, trial.fit->scatter);
  }
  for (Trial& trial : trials) {
    if (!trial.fit) continue;
    trial.readings = judge(*trial.fit, least, frames);
    trial.misfit = misfit_beside(trial.readings, trial.readings);
  }
}

/// With resistances of each line's own. Where two circuits explain the frames nearly as well, what lines differ by may
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

/// Empty where it leaves more than before: it has lost its way.
std::optional<CommonRatio> refit(const ArrayDescription& array, const std::vector<const CircuitFrame*>& frames,
                                 const Trial& trial) {
  Result<CommonRatio> refit = with_lines(LineParameters(as_kind(array, *trial.kind)), frames, *trial.fit);
  if (!refit) return std::nullopt;
  const Scatter scatter = lesser(refit->scatter, trial.fit->scatter);
  const double before = misfit_of(judge(*trial.fit, scatter, frames)).square;
  if (misfit_of(judge(*refit, scatter, frames)).square > before) return std::nullopt;
  return *std::move(refit);
}

/// Those that are near the best of the circuits, where there are several; all of them, or they would not compare.
void fit_lines_of_rivals(const ArrayDescription& array, const std::vector<const CircuitFrame*>& frames,
                         std::vector<Trial>& trials) {
  double least = std::numeric_limits<double>::infinity();
  const auto is_circuit = [](const Trial& trial) { return trial.fit && trial.kind->circuit != Circuit::none; };
  for (const Trial& trial : trials) {
    if (is_circuit(trial)) least = std::min(least, trial.misfit.square);
  }
  std::vector<Trial*> near;
  for (Trial& trial : trials) {
    if (is_circuit(trial) && trial.misfit.square <= kNearly * least) near.push_back(&trial);
  }
  if (near.size() < 2) return;
  std::vector<std::optional<CommonRatio>> refits;
  for (Trial* const trial : near) refits.push_back(refit(array, frames, *trial));
  const bool all_fitted = std::all_of(refits.begin(), refits.end(), [](const auto& fit) { return fit.has_value(); });
  for (std::size_t k = 0; k < near.size(); ++k) {
    near[k]->is_rough = !all_fitted;
    if (all_fitted) near[k]->fit = std::move(refits[k]);
  }
  judge(trials, frames);
}

void try_kinds(const ArrayDescription& array, const CircuitFrames& all, std::size_t most, std::vector<Trial>& trials) {
  const auto frames = select_frames(all, most);
  parallel_for(trials.size(), [&](std::size_t k) {
    const LineParameters lines(as_kind(array, *trials[k].kind));
    trials[k] = {.kind = trials[k].kind, .noise_share = unresolved_share(lines.array(), all)};
    if (trials[k].noise_share > 0.0) return;
    const Rubber unknown = unknown_rubber(all, array.taxel_count(), 1.0 / lines.reference_ohm());
    Result<CommonRatio> fit = fit_common_ratio(lines, frames, unknown);
    if (fit) trials[k].fit = *std::move(fit);
  });
  judge(trials, frames);
  fit_lines_of_rivals(array, frames, trials);
}

/// The sum of squares by which a circuit must be better to be told from another: readings that no circuit explains to
/// their noise count for less.
double sure_square(const FrameMisfit& best) {
  return kSureSquare * std::max(1.0, best.square / best.readings);
}

bool is_unresolved(const Trial& trial) {
  return trial.noise_share > 0.0;
}

/// What two kinds leave of the readings that tell in both.
struct Comparison {
  FrameMisfit first;
  FrameMisfit second;
};

Comparison compare(const Trial& first, const Trial& second) {
  if (!first.fit || !second.fit) return {first.misfit, second.misfit};  // infinite where it cannot give the frames
  if (!first.is_rough && !second.is_rough) {
    return {misfit_beside(first.readings, second.readings), misfit_beside(second.readings, first.readings)};
  }
  const std::size_t taxels = first.fit->array.taxel_count();
  return {rough_misfit_beside(first.readings, second.readings, taxels),
          rough_misfit_beside(second.readings, first.readings, taxels)};
}

bool has_less(const Trial& a, const Trial& b) {
  const Comparison both = compare(a, b);
  return both.first.square < both.second.square;
}

/// With lines whose differences could not be compared the odds must be far better.
bool is_surely_less(const Trial& better, const Trial& worse) {
  constexpr double kMargin = 10.0;
  const Comparison both = compare(better, worse);
  const double margin = better.is_rough && worse.is_rough ? kMargin : 1.0;
  return both.first.square + margin * sure_square(both.first) < both.second.square;
}

/// By a few frames, which leave the laws nearly free: they may take as much as they have terms.
bool is_refuted(const Trial& worse, const Trial& better) {
  if (!better.fit) return false;
  const Comparison both = compare(better, worse);
  const auto terms = static_cast<double>(kPressedTerms * static_cast<Eigen::Index>(better.fit->rubber.laws.size()));
  const double scale = std::max(1.0, both.first.square / both.first.readings);
  return both.first.square + (kSureSquare + terms) * scale < both.second.square;
}

/// Lines that taxels share have crosstalk. None is shown by presses that leave the idle taxels of their lines alone
/// although the circuit says that they must not, where the laws of the pressed ones do not suffer from it.
bool is_none_shown(const Trial& none, const Trial& circuit) {
  if (!circuit.fit) return true;
  const auto [of_none, of_circuit] = compare(none, circuit);
  const double law_square = misfit_of(none.readings).pressed_square;
  return is_surely_less(none, circuit) && law_square <= misfit_of(circuit.readings).pressed_square &&
         of_none.crossed_square + sure_square(of_none) < of_circuit.crossed_square;
}

/// Under loads on the whole array alone, what a circuit does and a law of the rubber look alike.
bool presses_parts(const CircuitFrames& frames) {
  return std::any_of(frames.frames.begin(), frames.frames.end(), [](const CircuitFrame& frame) {
    const auto is_pressed = [](float newtons) { return newtons > 0.0F; };
    const auto is_idle = [](float newtons) { return newtons == 0.0F; };
    return std::any_of(frame.newtons.begin(), frame.newtons.end(), is_pressed) &&
           std::any_of(frame.newtons.begin(), frame.newtons.end(), is_idle);
  });
}

/// No circuit only where that is shown against all of them. Where the true one may be among those that are not
/// resolved, one of the others must be better than none, and not by a law.
const Trial& choose(const std::vector<Trial>& trials, const CircuitFrames& frames) {
  const auto none = std::find_if(trials.begin(), trials.end(),
                                 [](const Trial& trial) { return trial.kind->circuit == Circuit::none; });
  const auto best = std::min_element(trials.begin(), none, has_less);
  if (none == trials.end()) return *best;
  if (std::any_of(trials.begin(), trials.end(), is_unresolved)) {
    return is_surely_less(*best, *none) && presses_parts(frames) ? *best : *none;
  }
  const bool is_shown =
      std::all_of(trials.begin(), none, [&](const Trial& circuit) { return is_none_shown(*none, circuit); });
  return is_shown ? *none : *best;
}

/// "none" is a rival of a circuit only where it leaves surely less.
bool is_told(const Trial& trial, const Trial& chosen) {
  return trial.kind->circuit == Circuit::none ? !is_surely_less(trial, chosen) : is_surely_less(chosen, trial);
}

std::vector<PressPair> presses_to_tell(const std::vector<Trial>& trials, const Trial& chosen,
                                       const CircuitFrames& frames) {
  std::vector<const CommonRatio*> circuits{&*chosen.fit};
  for (const Trial& trial : trials) {
    if (trial.kind != chosen.kind && !is_told(trial, chosen)) circuits.push_back(&*trial.fit);
  }
  if (circuits.size() == 1) return {};
  return telling_presses(circuits, frames, sure_square(chosen.misfit));
}

/// The chosen one, and what a few frames do not refute.
std::vector<Trial> rivals(const std::vector<Trial>& trials, const CircuitFrames& frames) {
  const Trial& chosen = choose(trials, frames);
  std::vector<Trial> rivals;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(rivals), [&](const Trial& trial) {
    return trial.kind == chosen.kind || is_unresolved(trial) || !is_refuted(trial, chosen);
  });
  return rivals;
}

bool has_kind(const std::vector<Trial>& trials, const Kind* kind) {
  return std::any_of(trials.begin(), trials.end(), [&](const Trial& trial) { return trial.kind == kind; });
}

CircuitCandidate candidate_of(const Trial& trial) {
  const double misfit = std::sqrt(trial.misfit.square / std::max(1.0, trial.misfit.readings));
  return {.name = trial.kind->name, .misfit = misfit, .noise_share = trial.noise_share};
}

void sort_candidates(std::vector<CircuitCandidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const CircuitCandidate& a, const CircuitCandidate& b) {
    return a.chosen != b.chosen ? a.chosen : a.misfit < b.misfit;
  });
}

std::vector<CircuitCandidate> candidates_of(const std::vector<Trial>& trials, const Trial& chosen) {
  std::vector<CircuitCandidate> candidates;
  for (const Trial& trial : trials) {
    candidates.push_back(candidate_of(trial));
    candidates.back().chosen = trial.kind == chosen.kind;
    candidates.back().indistinguishable = trial.kind != chosen.kind && !is_told(trial, chosen);
  }
  sort_candidates(candidates);
  return candidates;
}

/// By fewer frames than those that are left, so that they do not compare with them any more.
std::vector<CircuitCandidate> refuted_candidates(const std::vector<Trial>& trials, const std::vector<Trial>& left) {
  std::vector<CircuitCandidate> candidates;
  for (const Trial& trial : trials) {
    if (!has_kind(left, trial.kind)) candidates.push_back(candidate_of(trial));
  }
  sort_candidates(candidates);
  return candidates;
}

}  // namespace

ArrayDescription without_circuit(const ArrayDescription& array) {
  return as_kind(array, *std::find_if(std::begin(kKinds), std::end(kKinds),
                                      [](const Kind& kind) { return kind.circuit == Circuit::none; }));
}

Result<CircuitChoice> choose_circuit(const ArrayDescription& array, const CircuitFrames& frames) {
  std::vector<Trial> trials = all_kinds();
  const std::size_t few = few_frames(array.taxel_count());  // refute most circuits
  try_kinds(array, frames, few, trials);
  std::vector<Trial> left = rivals(trials, frames);
  const bool is_slow = std::any_of(left.begin(), left.end(), [](const Trial& trial) {
    return trial.fit && trial.kind->idle_rows == IdleRows::floating;
  });
  const std::size_t most = affordable_frames_of_choice(array.taxel_count(), is_slow);
  if (left.size() > 1 && most > few && frames.frames.size() > few) try_kinds(array, frames, most, left);
  const Trial& chosen = choose(left, frames);
  if (!chosen.fit) return bad_input("readout: no circuit explains the calibration frames");
  std::vector<CircuitCandidate> candidates = candidates_of(left, chosen);
  std::vector<CircuitCandidate> refuted = refuted_candidates(trials, left);
  std::move(refuted.begin(), refuted.end(), std::back_inserter(candidates));
  return CircuitChoice{as_kind(array, *chosen.kind), std::move(candidates), presses_to_tell(left, chosen, frames)};
}

}  // namespace dermis::calibration
