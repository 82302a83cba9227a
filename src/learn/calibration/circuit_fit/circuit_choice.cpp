// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/circuit_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <string>
#include <utility>

#include "learn/calibration/circuit_fit/circuit_trial.hpp"
#include "learn/calibration/circuit_fit/discriminating_presses.hpp"
#include "learn/calibration/circuit_fit/frame_selection.hpp"

namespace dermis::learn::calibration {
namespace {

/// Lines that taxels share have crosstalk. `none` is shown by presses that leave the idle taxels of their lines alone
/// although the circuit says that they must not. Only presses whose laws do not suffer from it count.
bool is_none_shown(const CircuitTrial& none, const CircuitTrial& circuit) {
  if (!circuit.fit) return true;
  const auto [of_none, of_circuit] = compare(none, circuit);
  const double law_square = misfit_of(none.readings).pressed_square;
  return is_surely_less(none, circuit) && law_square <= misfit_of(circuit.readings).pressed_square &&
         of_none.crossed_square + sure_square(of_none) < of_circuit.crossed_square;
}

/// The answer is `none` only where that is shown against all circuits. Where the true one may be among the unresolved
/// ones, a resolved one must be better than none, and not by a law.
const CircuitTrial& choose(const std::vector<CircuitTrial>& trials, const CircuitFrames& frames) {
  const auto none = std::find_if(trials.begin(), trials.end(), [](const CircuitTrial& trial) {
    return trial.array.readout.circuit == Circuit::none;
  });
  const auto best = std::min_element(trials.begin(), none, has_less);
  if (none == trials.end()) return *best;
  if (std::any_of(trials.begin(), trials.end(), std::mem_fn(&CircuitTrial::is_unresolved))) {
    const bool do_tell = std::any_of(frames.frames.begin(), frames.frames.end(), presses_part);
    return is_surely_less(*best, *none) && do_tell ? *best : *none;
  }
  const bool is_shown =
      std::all_of(trials.begin(), none, [&](const CircuitTrial& circuit) { return is_none_shown(*none, circuit); });
  return is_shown ? *none : *best;
}

/// `none` is a rival of a circuit only where its residual is surely less.
bool is_distinguishable(const CircuitTrial& trial, const CircuitTrial& chosen) {
  return trial.array.readout.circuit == Circuit::none ? !is_surely_less(trial, chosen) : is_surely_less(chosen, trial);
}

std::vector<PressPair> discriminating_presses_of(const std::vector<CircuitTrial>& trials, const CircuitTrial& chosen,
                                                 const CircuitFrames& frames) {
  std::vector<const CommonRatio*> circuits{&*chosen.fit};
  for (const CircuitTrial& trial : trials) {
    if (trial.name != chosen.name && !is_distinguishable(trial, chosen)) circuits.push_back(&*trial.fit);
  }
  if (circuits.size() == 1) return {};
  return discriminating_presses(circuits, frames, sure_square(chosen.misfit));
}

/// The chosen circuit, and those that a few frames do not refute.
std::vector<CircuitTrial> rivals(const std::vector<CircuitTrial>& trials, const CircuitFrames& frames) {
  const CircuitTrial& chosen = choose(trials, frames);
  std::vector<CircuitTrial> rivals;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(rivals), [&](const CircuitTrial& trial) {
    return trial.name == chosen.name || trial.is_unresolved() || !is_refuted(trial, chosen);
  });
  return rivals;
}

bool has_name(const std::vector<CircuitTrial>& trials, const std::string& name) {
  return std::any_of(trials.begin(), trials.end(), [&](const CircuitTrial& trial) { return trial.name == name; });
}

CircuitCandidate candidate_of(const CircuitTrial& trial) {
  const double misfit = std::sqrt(trial.misfit.square / std::max(1.0, trial.misfit.readings));
  return {.name = trial.name, .misfit = misfit, .noise_share = trial.noise_share};
}

void sort_candidates(std::vector<CircuitCandidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const CircuitCandidate& a, const CircuitCandidate& b) {
    return a.chosen != b.chosen ? a.chosen : a.misfit < b.misfit;
  });
}

std::vector<CircuitCandidate> candidates_of(const std::vector<CircuitTrial>& trials, const CircuitTrial& chosen) {
  std::vector<CircuitCandidate> candidates;
  for (const CircuitTrial& trial : trials) {
    candidates.push_back(candidate_of(trial));
    candidates.back().chosen = trial.name == chosen.name;
    candidates.back().indistinguishable = trial.name != chosen.name && !is_distinguishable(trial, chosen);
  }
  sort_candidates(candidates);
  return candidates;
}

/// Refuted circuits were judged by fewer frames than the ones left, so their misfits do not compare with these.
std::vector<CircuitCandidate> refuted_candidates(const std::vector<CircuitTrial>& trials,
                                                 const std::vector<CircuitTrial>& left) {
  std::vector<CircuitCandidate> candidates;
  for (const CircuitTrial& trial : trials) {
    if (!has_name(left, trial.name)) candidates.push_back(candidate_of(trial));
  }
  sort_candidates(candidates);
  return candidates;
}

}  // namespace

Result<CircuitChoice> choose_circuit(const ArrayDescription& array, const CircuitFrames& frames) {
  std::vector<CircuitTrial> trials = trials_of_all_kinds(array, frames);
  const std::size_t few = few_frames(array.taxel_count());  // refute most circuits
  fit_trials_and_lines(few, trials);
  std::vector<CircuitTrial> left = rivals(trials, frames);
  const bool is_slow = std::any_of(left.begin(), left.end(), [](const CircuitTrial& trial) {
    return trial.fit && trial.array.readout.idle_rows == IdleRows::floating;
  });
  const std::size_t most = affordable_frames_of_choice(array.taxel_count(), is_slow);
  if (left.size() > 1 && most > few && frames.frames.size() > few) fit_trials_and_lines(most, left);
  const CircuitTrial& chosen = choose(left, frames);
  if (!chosen.fit) return bad_input("readout: no circuit explains the calibration frames");
  std::vector<CircuitCandidate> candidates = candidates_of(left, chosen);
  std::vector<CircuitCandidate> refuted = refuted_candidates(trials, left);
  std::move(refuted.begin(), refuted.end(), std::back_inserter(candidates));
  return CircuitChoice{chosen.array, std::move(candidates), discriminating_presses_of(left, chosen, frames)};
}

}  // namespace dermis::learn::calibration
