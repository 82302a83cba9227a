// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/guide_messages.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "calibration/circuit_fit/telling_presses.hpp"

namespace dermis::calibration {
namespace {

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
      if (!frame.temperature_celsius) continue;
      sum += *frame.temperature_celsius;
      count += 1.0;
    }
  }
  if (count == 0.0) return " It holds for the temperature of today.";
  return fmt::format(" It holds for about {:.0f} C, and other temperatures are not corrected.", sum / count);
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
  std::string here = array.taxel_name(state.taxel);
  if (state.together_with) here += " and as much on " + array.taxel_name(*state.together_with);
  const std::string there = state.pressed_taxel ? array.taxel_name(*state.pressed_taxel) : "another taxel";
  const std::string weight = describe_weight(state.weight_n);
  switch (state.hint) {
    case GuideHint::none:
    case GuideHint::press:
      return fmt::format("{}Put {} on {}.", state.together_with ? "The circuit is not certain yet. " : "", weight,
                         here);
    case GuideHint::hold: return "Hold still.";
    case GuideHint::release:
      return state.together_with ? "Done. Take both off." : fmt::format("{} is done. Take it off.", here);
    case GuideHint::other_taxel: return fmt::format("That is {}: put {} on {}.", there, weight, here);
    case GuideHint::unsteady: return "Not steady yet: hold still.";
    case GuideHint::too_short: return fmt::format("Too short: put {} on {} again and wait.", weight, here);
    case GuideHint::several: return fmt::format("{} is pressed, too: press {} alone.", there, here);
  }
  return {};
}

std::string describe_fitting(const GuidedPresses& presses) {
  return fmt::format("Fitting {} presses.", presses.size());
}

std::string describe_result(const Calibration& calibration, const GuideState& state, const GuidedPresses& presses) {
  const TrainingReport& training = calibration.report.training;
  std::string text = fmt::format("{} presses of {:g} to {:g} N.", presses.size(), training.lightest_newtons,
                                 training.heaviest_newtons);
  text += describe_errors(state, calibration.model.array);
  if (!training.dead_taxels.empty()) {
    text += fmt::format(" {} taxels did not answer and are marked dead.", training.dead_taxels.size());
  }
  const std::vector<PressPair>& telling = calibration.report.telling_presses;
  if (!telling.empty()) {
    text += fmt::format(" The circuit is not certain: {}, add these frames to the saved ones and calibrate again.",
                        describe(telling, calibration.model.array));
  }
  text += fmt::format(" Forces above {:g} N are extrapolated, less and less surely, to eight times as much.",
                      training.heaviest_newtons);
  return text + describe_temperature(training, presses);
}

}  // namespace dermis::calibration
