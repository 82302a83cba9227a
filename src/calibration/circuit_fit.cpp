// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/circuit_fit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "calibration/circuit_frames.hpp"
#include "calibration/resistance_fit.hpp"
#include "dermis/core/random.hpp"

namespace dermis::calibration {
namespace {

constexpr double kWellKnown = 0.02;         // relative standard error below which a resistance counts as found
constexpr double kUnknown = 0.5;            // and above which nothing can be said
constexpr double kSureSigmas = 3.0;         // by which a circuit must be better to be told from another
constexpr double kCutSquare = 25.0;         // no single reading decides
constexpr std::size_t kTrainFrames = 1200;  // of each half of the frames that choose the circuit
constexpr std::uint64_t kSplitSeed = 2;

bool is_pressed(const CircuitFrame& frame) {
  return std::any_of(frame.newtons.begin(), frame.newtons.end(), [](float newtons) { return newtons > 0.0F; });
}

Status check_frames(const CircuitFrames& frames) {
  if (std::any_of(frames.frames.begin(), frames.frames.end(), is_pressed)) return Done{};
  return bad_input(
      "readout: no frame presses a taxel with a known force, so its unknown resistances cannot be found: record "
      "presses, or give drive_ohm and load_ohm");
}

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

/// Tries every kind on presses that it was not fitted to.
Result<std::vector<CircuitCandidate>> choose_kind(const ArrayDescription& array, const CircuitFrames& frames,
                                                  const Kind*& chosen) {
  const auto [first, second] = split(frames);
  std::vector<Trial> trials;
  for (const Kind& kind : kKinds) {
    Trial trial{&kind, {}, std::numeric_limits<double>::infinity()};
    const Result<ResistanceFit> fit = fit_resistances(as_kind(array, kind), first);
    if (fit) {
      trial.squares = judge_frames(*fit, second, kCutSquare);
      trial.mean = mean_of(trial.squares);
    }
    trials.push_back(std::move(trial));
  }
  const auto best =
      std::min_element(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.mean < b.mean; });
  if (!std::isfinite(best->mean)) return bad_input("readout: no circuit explains the calibration frames");
  chosen = best->kind;
  std::vector<CircuitCandidate> candidates;
  for (const Trial& trial : trials) {
    const bool is_best = trial.kind == best->kind;
    const bool close = !is_best && std::isfinite(trial.mean) && sigmas_worse(*best, trial) < kSureSigmas;
    candidates.push_back({trial.kind->name, std::sqrt(trial.mean), is_best, close});
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const CircuitCandidate& a, const CircuitCandidate& b) {
    return a.held_out_error < b.held_out_error;
  });
  return candidates;
}

std::string describe_choice(const std::vector<CircuitCandidate>& candidates) {
  std::string text = fmt::format("circuit: {} (held-out error {:.3g} standard deviations of a reading;",
                                 candidates.front().name, candidates.front().held_out_error);
  for (std::size_t k = 1; k < candidates.size(); ++k) {
    text += std::isfinite(candidates[k].held_out_error)
                ? fmt::format(" {} {:.3g}{}", candidates[k].name, candidates[k].held_out_error,
                              k + 1 < candidates.size() ? ";" : ")")
                : fmt::format(" {} not possible{}", candidates[k].name, k + 1 < candidates.size() ? ";" : ")");
  }
  return text;
}

std::optional<std::string> describe_doubt(const std::vector<CircuitCandidate>& candidates) {
  std::string names;
  for (const CircuitCandidate& candidate : candidates) {
    if (candidate.indistinguishable) names += (names.empty() ? "\"" : ", \"") + candidate.name + "\"";
  }
  if (names.empty()) return std::nullopt;
  return "these frames do not tell the chosen circuit from " + names +
         "; record heavy presses, and two or more weights in one row and in one column";
}

/// "18.2 to 22.1 ohm, +-2.6 to 3.1 % each" of the fitted lines of a kind.
struct Range {
  double least_ohm = std::numeric_limits<double>::infinity();
  double most_ohm = 0.0;
  double best_error = 1.0;
  double worst_error = 0.0;
  std::size_t count = 0;
};

Range fitted_range(const std::vector<double>& ohms, const std::vector<double>& errors) {
  Range range;
  for (std::size_t k = 0; k < ohms.size(); ++k) {
    if (errors[k] == 0.0) continue;
    range.least_ohm = std::min(range.least_ohm, ohms[k]);
    range.most_ohm = std::max(range.most_ohm, ohms[k]);
    range.best_error = std::min(range.best_error, errors[k]);
    range.worst_error = std::max(range.worst_error, errors[k]);
    ++range.count;
  }
  return range;
}

std::string describe(const char* name, const Range& range) {
  return fmt::format("{}: {} fitted, {:.4g} to {:.4g} ohm, standard error {:.1f} to {:.1f} % each", name, range.count,
                     range.least_ohm, range.most_ohm, 100.0 * range.best_error, 100.0 * range.worst_error);
}

void describe_drives(const ResistanceFit& fit, std::vector<std::string>& statements) {
  const Range drives = fitted_range(fit.array.readout.drive_ohm, fit.drive_error);
  if (drives.count == 0) return;
  if (drives.worst_error > kUnknown) {
    statements.push_back(fmt::format(
        "drive_ohm: too small for these frames to tell, at most about {:.3g} ohm; what is left of its crosstalk is as "
        "small, and forces hardly depend on it",
        drives.most_ohm * (1.0 + 2.0 * drives.worst_error)));
    return;
  }
  statements.push_back(describe("drive_ohm", drives));
  if (drives.count > 1) {
    statements.back() += fmt::format(", {:.1f} % their mean", 100.0 * fit.common_drive_error);
  }
  if (drives.worst_error > kWellKnown) {
    statements.push_back(
        "drive_ohm: a few frames with heavy weights on several taxels of each row at once, or with a uniform load "
        "on the whole array, determine it better than any number of single presses");
  }
}

void describe_loads(const ResistanceFit& fit, std::vector<std::string>& statements) {
  const Range loads = fitted_range(fit.array.readout.load_ohm, fit.load_error);
  if (loads.count == 0) return;
  statements.push_back(describe("load_ohm", loads));
  if (fit.sheet_scatter > 0.0) {
    statements.push_back(
        fmt::format("load_ohm: rests on the unloaded rubber differing from line to line across the loads by no more "
                    "than it does along them, {:.1f} %",
                    100.0 * fit.sheet_scatter));
  }
}

std::vector<std::string> describe(const ResistanceFit& fit) {
  std::vector<std::string> statements;
  if (fit.array.readout.circuit == Circuit::none) {
    statements.emplace_back("no circuit explains the frames better than none: crosstalk stays in the forces");
    return statements;
  }
  if (!fit.has_absolute) {
    statements.push_back(
        fmt::format("no resistance is known, so only ratios are determined: the loads' geometric mean is set to {:g} "
                    "ohm; forces do not depend on it",
                    kNominalLoadOhm));
  }
  describe_drives(fit, statements);
  describe_loads(fit, statements);
  if (fit.idle_readings == 0) {
    statements.emplace_back(
        "the readings of idle taxels are too close to 0 to show crosstalk: the resistances rest on taxels that are "
        "pressed together");
  }
  return statements;
}

}  // namespace

Result<CircuitFit> fit_circuit(const ArrayDescription& array, std::span<const RawFrame> frames,
                               std::span<const Load> loads, Nanos settle_time) {
  const Result<CircuitFrames> labelled = circuit_frames(array, frames, loads, settle_time);
  if (!labelled) return labelled.error();
  if (Status checked = check_frames(*labelled); !checked) return checked.error();
  CircuitFit result;
  result.array = array;
  if (array.readout.circuit == Circuit::automatic) {
    const Kind* chosen = nullptr;
    Result<std::vector<CircuitCandidate>> candidates = choose_kind(array, *labelled, chosen);
    if (!candidates) return candidates.error();
    result.candidates = std::move(*candidates);
    result.array = as_kind(array, *chosen);
    result.statements.push_back(describe_choice(result.candidates));
    if (const auto doubt = describe_doubt(result.candidates)) result.statements.push_back(*doubt);
  }
  Result<ResistanceFit> fit = fit_resistances(result.array, *labelled);
  if (!fit) return fit.error();
  const std::vector<std::string> found = describe(*fit);
  result.statements.insert(result.statements.end(), found.begin(), found.end());
  result.array = std::move(fit->array);
  result.drive_error = std::move(fit->drive_error);
  result.load_error = std::move(fit->load_error);
  result.common_drive_error = fit->common_drive_error;
  result.rubber_scatter = fit->rubber_scatter;
  result.frames = labelled->frames.size();
  return result;
}

}  // namespace dermis::calibration
