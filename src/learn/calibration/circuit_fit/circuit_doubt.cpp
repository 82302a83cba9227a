// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/circuit_doubt.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "learn/calibration/circuit_fit/circuit_trial.hpp"
#include "learn/calibration/circuit_fit/frame_selection.hpp"
#include "learn/calibration/mean.hpp"

namespace dermis::learn::calibration {
namespace {

using Trials = std::vector<CircuitTrial>;

const double kLikely = 2.0 * std::log(100.0);  // odds of a hundred to one distinguish resistances

/// Both lines of a taxel are connected, all others float; "auto" does not try it.
bool has_two_wires(const Readout& readout) {
  return readout.circuit == Circuit::divider && readout.idle_rows == IdleRows::floating &&
         readout.idle_columns == IdleColumns::floating;
}

/// Frames that an inversion of two wires allows for: each product with its Jacobian takes taxels^2 multiplications.
std::size_t affordable_with_two_wires(const ArrayDescription& array) {
  constexpr double kMostMultiplications = 3e10;
  constexpr double kProducts = 1e4;  // for a frame, of all ratios that are tried
  const auto taxels = static_cast<double>(array.taxel_count());
  return static_cast<std::size_t>(kMostMultiplications / (kProducts * taxels * taxels));
}

/// Frames by which the description is judged.
std::size_t affordable(const ArrayDescription& array) {
  constexpr std::size_t kTaxels = 40'000;
  constexpr std::size_t kMost = 400;
  const std::size_t most = std::clamp(kTaxels / array.taxel_count(), few_frames(array.taxel_count()), kMost);
  return has_two_wires(array.readout) ? std::min(most, affordable_with_two_wires(array)) : most;
}

/// Idle taxels on the lines of a press show crosstalk; others show other effects.
bool leaves_crosstalk(const CircuitTrial& described) {
  constexpr double kMuch = 1.1;  // of squares on pressed lines, over those elsewhere
  constexpr double kSure = 5.0;  // standard deviations
  if (!described.fit) return true;
  const FrameMisfit misfit = misfit_of(described.readings);
  const double others = misfit.readings - misfit.crossed_readings - misfit.pressed_readings;
  const double of_others = misfit.square - misfit.crossed_square - misfit.pressed_square;
  if (others < 1.0 || misfit.crossed_readings < 1.0 || of_others <= 0.0) return false;
  const double ratio = misfit.crossed_square / misfit.crossed_readings / (of_others / others);
  return ratio > kMuch && ratio - 1.0 > kSure * std::sqrt(2.0 / misfit.crossed_readings + 2.0 / others);
}

/// Everything but its ADC is unknown.
ArrayDescription without_readout(ArrayDescription array) {
  Readout unknown;
  unknown.circuit = Circuit::automatic;
  unknown.adc_bits = array.readout.adc_bits;
  unknown.adc_noise_counts = array.readout.adc_noise_counts;
  unknown.adc_reference_v = array.readout.adc_reference_v;
  unknown.supply_v = array.readout.supply_v;
  unknown.pressure_raises_reading = array.readout.pressure_raises_reading;
  array.readout = std::move(unknown);
  return array;
}

/// The kind that "auto" does not try.
CircuitTrial two_wires_of(const ArrayDescription& array, const CircuitFrames& frames) {
  const Trials kinds = trials_of_all_kinds(without_readout(array), frames);
  CircuitTrial trial = *std::find_if(kinds.begin(), kinds.end(), [](const CircuitTrial& kind) {
    return kind.array.readout.circuit == Circuit::divider && kind.array.readout.idle_rows == IdleRows::floating;
  });
  trial.name = "divider, idle rows and columns floating";
  trial.array.readout.idle_columns = IdleColumns::floating;
  return trial;
}

bool is_same_kind(const Readout& a, const Readout& b) {
  return a.circuit == b.circuit && a.idle_rows == b.idle_rows && a.idle_columns == b.idle_columns;
}

/// Mean driver over mean load: single presses determine no more of the resistances. 0 without a circuit.
double drive_over_load(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  if (readout.drive_ohm.empty()) return 0.0;
  return mean_of(readout.drive_ohm) / mean_of(readout.load_ohm);
}

/// Differences within the tolerance of parts hardly change forces.
bool are_alike(double ratio, double other) {
  constexpr double kFactor = 2.0;
  constexpr double kNothing = 0.003;
  return std::max(ratio, other) <= kFactor * std::min(ratio, other) + kNothing;
}

/// A circuit of the same kind with quite different resistances explains more, and the idle taxels on pressed lines show
/// it. Pressed taxels do not: contacts in series with taxels bend laws as drivers do.
bool has_other_resistances(const CircuitTrial& described, const CircuitTrial& free) {
  if (!described.fit || !free.fit) return false;
  if (are_alike(drive_over_load(described.fit->array), drive_over_load(free.fit->array))) return false;
  const auto [of_free, of_described] = compare(free, described);
  const double scale = std::max(1.0, of_free.square / of_free.readings);
  return of_free.square + kLikely * scale < of_described.square &&
         of_free.crossed_square + kLikely * scale < of_described.crossed_square;
}

/// The same circuit with the common ADC of the fewest bits that can give all readings, where it is smaller.
std::optional<ArrayDescription> with_smaller_adc(ArrayDescription array, double highest_counts) {
  for (const int bits : {8, 10, 12, 14, 16}) {
    if (bits >= array.readout.adc_bits) break;
    if (highest_counts > std::exp2(bits) - 1.0) continue;
    array.readout.adc_bits = bits;
    return array;
  }
  return std::nullopt;
}

/// As `smaller` would read the counts of `array`.
CircuitFrames rescaled(CircuitFrames frames, const ArrayDescription& array, const ArrayDescription& smaller) {
  const double scale = array.readout.full_scale_counts() / smaller.readout.full_scale_counts();
  for (CircuitFrame& frame : frames.frames) {
    for (double& ratio : frame.ratio) ratio *= scale;
    frame.sigma_ratio *= scale;
    frame.described_sigma *= scale;
  }
  return frames;
}

/// "divider, idle rows grounded" and the circuits that the frames do not distinguish from it.
std::string names_of_best(const Trials& rivals, const CircuitTrial& best) {
  std::string names = '"' + best.name + '"';
  for (const CircuitTrial& rival : rivals) {
    if (rival.name != best.name && rival.fit && !is_surely_less(best, rival)) names += " or \"" + rival.name + '"';
  }
  return names;
}

std::string describe(const Trials& rivals, const CircuitTrial& best, const ArrayDescription& array, double highest) {
  if (best.array.readout.adc_bits != array.readout.adc_bits) {
    return fmt::format(
        "no reading is above {:.0f} counts, and these frames fit an ADC of {} bits better than {}: check adc_bits",
        highest, best.array.readout.adc_bits, array.readout.adc_bits);
  }
  if (is_same_kind(best.array.readout, array.readout)) {
    return fmt::format(
        "these frames fit drivers of {:.2g} times the loads better than the {:.2g} of array.toml: check "
        "drive_ohm and load_ohm, or write \"fit\"",
        drive_over_load(best.fit->array), drive_over_load(array));
  }
  return fmt::format("these frames fit {} better than the circuit of array.toml: {}", names_of_best(rivals, best),
                     has_two_wires(best.array.readout)
                         ? "write idle_rows and idle_columns = \"floating\", and check drive_ohm and load_ohm"
                         : "check readout, or write circuit = \"auto\"");
}

/// Two wires in an array of many taxels, where they explain better than the best of the other kinds. Empty: they do
/// not. They are judged by few frames, all of which press a part of the array.
std::optional<CircuitTrial> better_two_wires(const CircuitTrial& best, const CircuitTrial& described) {
  CircuitFrames telling = *described.frames;
  std::erase_if(telling.frames, [](const CircuitFrame& frame) { return !presses_part(frame); });
  Trials trials{two_wires_of(described.array, telling), described};
  if (best.frames == described.frames) trials.push_back(best);  // not of another ADC
  for (CircuitTrial& trial : trials) trial.frames = &telling;
  fit_trials(affordable_with_two_wires(described.array), trials);
  const CircuitTrial& found = trials.front();
  const bool is_better = std::all_of(std::next(trials.begin()), trials.end(),
                                     [&](const CircuitTrial& other) { return is_surely_less(found, other); });
  return is_better ? std::optional(found) : std::nullopt;
}

}  // namespace

std::optional<CircuitDoubt> doubt_circuit(const ArrayDescription& array, const CircuitFrames& frames) {
  constexpr std::size_t kFewest = 8;
  const std::size_t most = affordable(array);
  const std::size_t most_of_two_wires = affordable_with_two_wires(array);
  if (array.has_unknown_circuit() || most < kFewest) return std::nullopt;
  const CircuitTrial described{.name = "array.toml", .array = array, .frames = &frames};
  Trials rivals = trials_of_all_kinds(without_readout(array), frames);
  if (most_of_two_wires >= most) rivals.push_back(two_wires_of(array, frames));
  Trials trials{described};
  if (std::any_of(frames.frames.begin(), frames.frames.end(), presses_part)) {
    std::copy_if(rivals.begin(), rivals.end(), std::back_inserter(trials),
                 [&](const CircuitTrial& rival) { return is_same_kind(rival.array.readout, array.readout); });
  }
  fit_trials(most, trials);
  const bool are_resistances_others = has_other_resistances(trials.front(), trials.back());
  if (!are_resistances_others && !leaves_crosstalk(trials.front())) return std::nullopt;

  const double highest = highest_ratio(frames) * array.readout.full_scale_counts();
  const std::optional<ArrayDescription> smaller = with_smaller_adc(array, highest);
  const CircuitFrames of_smaller = smaller ? rescaled(frames, array, *smaller) : CircuitFrames();
  if (smaller) rivals.push_back({.name = "a smaller ADC", .array = *smaller, .frames = &of_smaller});
  rivals.push_back(described);
  fit_trials(most, rivals);
  const CircuitTrial judged = std::move(rivals.back());
  rivals.pop_back();
  const CircuitTrial& best = *std::min_element(rivals.begin(), rivals.end(), has_less);
  if (most_of_two_wires >= kFewest && most_of_two_wires < most) {
    const std::optional<CircuitTrial> two_wires = better_two_wires(best, described);
    if (two_wires && two_wires->fit) {
      return CircuitDoubt{describe({}, *two_wires, array, highest), two_wires->fit->array};
    }
  }
  if (!best.fit || (!are_resistances_others && !is_surely_less(best, judged))) return std::nullopt;
  return CircuitDoubt{describe(rivals, best, array, highest), best.fit->array};
}

}  // namespace dermis::learn::calibration
