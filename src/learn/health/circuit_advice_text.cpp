// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dermis/learn/health/circuit_advice.hpp"

namespace dermis::learn::health {
namespace {

std::string ohm_text(double ohm) {
  if (ohm >= 999.5e3) return fmt::format("{:.3g} Mohm", ohm / 1e6);
  return ohm >= 999.5 ? fmt::format("{:.3g} kohm", ohm / 1e3) : fmt::format("{:.3g} ohm", ohm);
}

/// "20 ohm", or "18 to 22 ohm" where the lines differ.
std::string ohms_text(const std::vector<double>& ohms) {
  const auto [least, most] = std::minmax_element(ohms.begin(), ohms.end());
  return *least == *most ? ohm_text(*least) : ohm_text(*least) + " to " + ohm_text(*most);
}

std::string percent(double share) {
  return share < 1.0 ? fmt::format("{:.2g} %", 100.0 * share) : fmt::format("{:.0f} %", 100.0 * share);
}

std::string circuit_text(const Readout& readout) {
  std::string text = to_string(readout.circuit);
  if (readout.circuit != Circuit::flexitac) text += fmt::format(", idle rows {}", to_string(readout.idle_rows));
  if (readout.circuit == Circuit::divider) text += fmt::format(", idle columns {}", to_string(readout.idle_columns));
  return text;
}

std::string precision_text(const std::optional<Precision>& precision) {
  if (!precision) return "readings beyond the ADC or without a solution";
  return fmt::format("{} in the mean, at most {} for half of the pressed taxels, {} for 95 %, {} for the worst",
                     percent(precision->mean), percent(precision->median), percent(precision->p95),
                     percent(precision->worst));
}

/// The loads around the best one.
std::string table_of(const CircuitAdvice& advice) {
  constexpr double kShownFactor = 25.0;
  const double best_ohm = advice.loads[advice.best].load_ohm;
  std::string text = fmt::format("{:>12}{:>12}{:>12}{:>12}{:>12}\n", "load", "mean", "median", "95 %", "worst");
  for (const ResistorChoice& choice : advice.loads) {
    if (std::abs(std::log(choice.load_ohm / best_ohm)) > std::log(kShownFactor)) continue;
    if (!choice.precision) {
      text += fmt::format("{:>12}   {}\n", ohm_text(choice.load_ohm), precision_text(choice.precision));
      continue;
    }
    const Precision& precision = *choice.precision;
    text += fmt::format("{:>12}{:>12}{:>12}{:>12}{:>12}{}\n", ohm_text(choice.load_ohm), percent(precision.mean),
                        percent(precision.median), percent(precision.p95), percent(precision.worst),
                        choice.load_ohm == best_ohm ? "   best" : "");
  }
  return text;
}

std::string drive_text(const CircuitAdvice& advice, const Readout& readout) {
  if (!advice.ideal_drivers) return "Drive: ideal drivers would bring readings beyond the ADC.\n";
  return fmt::format("Drive: the less the better. Ideal drivers: {}.\n", precision_text(advice.ideal_drivers)) +
         fmt::format("       Up to {} the mean grows by less than 10 %; now the drivers have {}.\n",
                     ohm_text(advice.most_drive_ohm), ohms_text(readout.drive_ohm));
}

}  // namespace

std::string describe(const CircuitAdvice& advice, const ArrayDescription& array) {
  const Readout& readout = array.readout;
  const ResistorChoice& best = advice.loads[advice.best];
  std::string text =
      fmt::format("{} x {} taxels of {} to {}, {}, drivers of {}, noise of a reading {} of the supply.\n", array.rows,
                  array.cols, ohm_text(advice.taxels.least_ohm), ohm_text(advice.taxels.most_ohm),
                  circuit_text(readout), ohms_text(readout.drive_ohm), percent(advice.noise_ratio));
  text += "Relative 1-sigma of a conductance in one frame:\n\n" + table_of(advice);
  text += fmt::format("\nLoad: take {} on every line: {}.\n", ohm_text(best.load_ohm), precision_text(best.precision));
  text += fmt::format("      Now, with {}: {}.\n", ohms_text(readout.load_ohm), precision_text(advice.present));
  return text + drive_text(advice, readout);
}

}  // namespace dermis::learn::health
