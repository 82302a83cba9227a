// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/circuit_fit.hpp"

#include <algorithm>
#include <utility>

#include "learn/calibration/circuit_fit/circuit_choice.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/circuit_statements.hpp"
#include "learn/calibration/circuit_fit/circuit_trial.hpp"
#include "learn/calibration/circuit_fit/resistance_fit.hpp"
#include "learn/calibration/circuit_fit/resolution.hpp"

namespace dermis::learn::calibration {
namespace {

bool is_pressed(const CircuitFrame& frame) {
  return std::any_of(frame.newtons.begin(), frame.newtons.end(), [](float newtons) { return newtons > 0.0F; });
}

Status check_frames(const CircuitFrames& frames) {
  if (std::any_of(frames.frames.begin(), frames.frames.end(), is_pressed)) return Done{};
  return bad_input(
      "readout: no frame presses a taxel with a known force, so its unknown resistances cannot be found: record "
      "presses, or give drive_ohm and load_ohm");
}

}  // namespace

Result<CircuitFit> fit_circuit(const ArrayDescription& array, std::span<const RawFrame> frames,
                               std::span<const Load> loads, Nanos settle_time) {
  const Result<CircuitFrames> labelled = circuit_frames(array, frames, loads, settle_time);
  if (!labelled) return labelled.error();
  CircuitFit result;
  result.array = array;
  result.frames = labelled->frames.size();
  const double share = array.readout.circuit == Circuit::automatic ? 0.0 : unresolved_share(array, *labelled);
  if (share > 0.0) {
    result.array = without_circuit(array);
    result.statements = {describe_unresolved("this circuit", share) +
                         ": readings are taken as they are, and forces hold for loads like these"};
    return result;
  }
  if (!array.has_unknown_circuit()) return result;
  if (Status checked = check_frames(*labelled); !checked) return checked.error();
  if (array.readout.circuit == Circuit::automatic) {
    Result<CircuitChoice> choice = choose_circuit(array, *labelled);
    if (!choice) return choice.error();
    result.array = std::move(choice->array);
    result.candidates = std::move(choice->candidates);
    result.discriminating_presses = std::move(choice->discriminating_presses);
    result.statements = describe_choice(array, result.candidates, result.discriminating_presses);
  }
  Result<ResistanceFit> fit = fit_resistances(result.array, *labelled);
  if (!fit) return fit.error();
  const std::vector<std::string> found = describe_fit(*fit);
  result.statements.insert(result.statements.end(), found.begin(), found.end());
  result.array = std::move(fit->array);
  result.drive_error = std::move(fit->errors.drive);
  result.load_error = std::move(fit->errors.load);
  result.common_drive_error = fit->errors.common_drive;
  result.driver_presses = std::move(fit->driver_presses);
  result.rubber_scatter = fit->rubber_scatter;
  return result;
}

}  // namespace dermis::learn::calibration
