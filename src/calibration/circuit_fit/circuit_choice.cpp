// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/circuit_fit/circuit_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "calibration/circuit_fit/resistance_fit.hpp"
#include "dermis/core/random.hpp"

namespace dermis::calibration {
namespace {

constexpr double kSureSigmas = 3.0;         // by which a circuit must be better to be told from another
constexpr double kCutSquare = 25.0;         // no single reading decides
constexpr std::size_t kTrainFrames = 1200;  // of each half of the frames that choose the circuit
constexpr std::uint64_t kSplitSeed = 2;

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

/// Two halves, of at most kTrainFrames each, drawn by lot.
std::pair<CircuitFrames, CircuitFrames> split(const CircuitFrames& frames) {
  std::pair<CircuitFrames, CircuitFrames> halves;
  halves.first.has_temperature = frames.has_temperature;
  halves.second.has_temperature = frames.has_temperature;
  const double share = 2.0 * static_cast<double>(kTrainFrames) / static_cast<double>(frames.frames.size());
  for (std::size_t k = 0; k < frames.frames.size(); ++k) {
    const double lot = Random::stream(kSplitSeed, k).uniform();
    if (lot >= share) continue;
    (lot < 0.5 * std::min(share, 1.0) ? halves.first : halves.second).frames.push_back(frames.frames[k]);
  }
  return halves;
}

/// Mean square of what each kind leaves of each held-out frame.
struct Trial {
  const Kind* kind;
  std::vector<double> squares;
  double mean = 0.0;
};

double mean_of(const std::vector<double>& squares) {
  double sum = 0.0;
  double count = 0.0;
  for (const double square : squares) {
    if (std::isnan(square)) continue;
    sum += square;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::infinity();
}

/// Standard errors by which `other` is worse than `best`, from the frames' differences.
double sigmas_worse(const Trial& best, const Trial& other) {
  double sum = 0.0;
  double square = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < best.squares.size(); ++k) {
    const double difference = other.squares[k] - best.squares[k];
    if (std::isnan(difference)) continue;
    sum += difference;
    square += difference * difference;
    count += 1.0;
  }
  if (count < 2.0) return 0.0;
  const double variance = (square - sum * sum / count) / (count - 1.0);
  return variance > 0.0 ? sum / std::sqrt(count * variance) : 0.0;
}

Trial try_kind(const Kind& kind, const ArrayDescription& array, const CircuitFrames& first,
               const CircuitFrames& second) {
  Trial trial{&kind, {}, std::numeric_limits<double>::infinity()};
  const Result<ResistanceFit> fit = fit_resistances(as_kind(array, kind), first);
  if (!fit) return trial;
  trial.squares = judge_frames(*fit, second, kCutSquare);
  trial.mean = mean_of(trial.squares);
  return trial;
}

std::vector<CircuitCandidate> candidates_of(const std::vector<Trial>& trials, const Trial& best) {
  std::vector<CircuitCandidate> candidates;
  for (const Trial& trial : trials) {
    const bool is_best = trial.kind == best.kind;
    const bool close = !is_best && std::isfinite(trial.mean) && sigmas_worse(best, trial) < kSureSigmas;
    candidates.push_back({trial.kind->name, std::sqrt(trial.mean), is_best, close});
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const CircuitCandidate& a, const CircuitCandidate& b) {
    return a.held_out_error < b.held_out_error;
  });
  return candidates;
}

}  // namespace

Result<CircuitChoice> choose_circuit(const ArrayDescription& array, const CircuitFrames& frames) {
  const auto [first, second] = split(frames);
  std::vector<Trial> trials;
  for (const Kind& kind : kKinds) trials.push_back(try_kind(kind, array, first, second));
  const auto best =
      std::min_element(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.mean < b.mean; });
  if (!std::isfinite(best->mean)) return bad_input("readout: no circuit explains the calibration frames");
  return CircuitChoice{as_kind(array, *best->kind), candidates_of(trials, *best)};
}

}  // namespace dermis::calibration
