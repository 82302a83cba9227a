// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/guide_messages.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dermis/touch/frames/mean_celsius.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kShareThatTells = 0.05;  // how long the rest takes
constexpr double kGramsPerNewton = 1000.0 / 9.80665;

std::string describe_errors(const GuideState& state, const ArrayDescription& array) {
  const auto pressed = static_cast<std::size_t>(std::count_if(state.taxel_presses.begin(), state.taxel_presses.end(),
                                                              [](std::uint8_t presses) { return presses > 0; }));
  std::string text;
  if (state.median_relative_error) {
    text +=
        fmt::format(" Presses that the fit did not see: median error {:.1f} %.", 100.0 * *state.median_relative_error);
  }
  if (state.unpressed_relative_error && pressed < array.taxel_count()) {
    text += fmt::format(" {} taxels were not pressed and share what the others taught: about {:.0f} % there.",
                        array.taxel_count() - pressed, 100.0 * *state.unpressed_relative_error);
  }
  return text;
}

std::string describe_temperature(const TrainingReport& training, const GuidedPresses& presses) {
  if (training.uses_temperature) {
    return fmt::format(" It holds for {:.1f} to {:.1f} C.", training.lowest_celsius, training.highest_celsius);
  }
  double sum = 0.0;
  double count = 0.0;
  for (const auto& press : presses) {
    for (const RawFrame& frame : press->frames) {
      const std::optional<double> celsius = mean_celsius(frame);
      if (!celsius) continue;
      sum += *celsius;
      count += 1.0;
    }
  }
  if (count == 0.0) return " It holds for the temperature of today.";
  return fmt::format(" It holds for about {:.0f} C, and other temperatures are not corrected.", sum / count);
}

std::string name_of(std::optional<std::size_t> taxel, const ArrayDescription& array) {
  return taxel ? array.taxel_name(*taxel) : "another taxel";
}

/// One of the two taxels that are asked for is pressed, and another taxel in place of the other.
std::string describe_misplaced(const GuideState& state, const ArrayDescription& array) {
  const bool is_first_missing = state.missing_taxel == state.taxel;
  return fmt::format("That is {}: put {} on {} instead. {} is right.", name_of(state.pressed_taxel, array),
                     describe_weight(state.weight_n), name_of(state.missing_taxel, array),
                     name_of(is_first_missing ? state.together_with : state.taxel, array));
}

}  // namespace

std::string describe_weight(double newtons) {
  const double grams = newtons * kGramsPerNewton;
  return grams < 1000.0 ? fmt::format("{:g} N ({:.0f} g)", newtons, grams)
                        : fmt::format("{:g} N ({:.2f} kg)", newtons, grams / 1000.0);
}

std::string describe_quiet(bool is_disturbed) {
  return is_disturbed ? "Something moves on the array: take everything off and leave it alone."
                      : "Take everything off the array and leave it alone.";
}

std::string describe_press(const GuideState& state, const ArrayDescription& array) {
  const bool is_pair = state.together_with.has_value();
  const std::string first = array.taxel_name(state.taxel);
  const std::string second = name_of(state.together_with, array);
  const std::string here = is_pair ? first + " and " + second : first;
  const std::string there = name_of(state.pressed_taxel, array);
  const std::string weight = describe_weight(state.weight_n);
  const std::string press = fmt::format("{} on {}", weight, is_pair ? first + " and as much on " + second : first);
  switch (state.hint) {
    case GuideHint::none:
    case GuideHint::press: return (is_pair ? "To be sure of the circuit, put " : "Put ") + press + ".";
    case GuideHint::hold: return is_pair ? "Hold both still." : "Hold still.";
    case GuideHint::release: return here + (is_pair ? " are done. Take both off." : " is done. Take it off.");
    case GuideHint::other_taxel:
      return state.missing_taxel ? describe_misplaced(state, array) : fmt::format("That is {}: put {}.", there, press);
    case GuideHint::unsteady: return is_pair ? "Not steady yet: hold both still." : "Not steady yet: hold still.";
    case GuideHint::too_short: return fmt::format("Too short: put {} again and wait.", press);
    case GuideHint::several: return fmt::format("{} is pressed, too: press {} alone.", there, here);
    case GuideHint::one_of_two:
      return fmt::format("Only {} is pressed: put {} on {}, too.", there, weight, name_of(state.missing_taxel, array));
  }
  return {};
}

std::string describe_fitting(const GuidedPresses& presses, double share, double seconds) {
  if (share < kShareThatTells) return fmt::format("Fitting {} presses, for {:.0f} s so far.", presses.size(), seconds);
  const double left = std::ceil(seconds * (1.0 - share) / share);
  return fmt::format("Fitting {} presses: about {:.0f} s left.", presses.size(), left);
}

std::string describe_result(const Calibration& calibration, const GuideState& state, const GuidedPresses& presses) {
  const TrainingReport& training = calibration.report.training;
  std::string text = fmt::format("{} presses of {:g} to {:g} N.", presses.size(), training.lightest_newtons,
                                 training.heaviest_newtons);
  text += describe_errors(state, calibration.model.array);
  if (!training.dead_taxels.empty()) {
    text += fmt::format(" {} taxels did not answer and are marked dead.", training.dead_taxels.size());
  }
  const std::vector<PressPair>& discriminating = calibration.report.discriminating_presses;
  if (!discriminating.empty()) {
    text += fmt::format(" The circuit is not certain: {}, add these frames to the saved ones and calibrate again.",
                        describe(discriminating, calibration.model.array));
  }
  for (const std::string& doubt : calibration.report.doubts) text += " Doubtful: " + doubt + ".";
  text += fmt::format(" Forces above {:g} N are extrapolated, less and less surely, to eight times as much.",
                      training.heaviest_newtons);
  return text + describe_temperature(training, presses);
}

}  // namespace dermis::learn::calibration
