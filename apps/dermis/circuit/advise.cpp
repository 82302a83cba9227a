// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "circuit/advise.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "circuit/advice.hpp"
#include "circuit/known_circuit.hpp"
#include "progress.hpp"

namespace dermis::app {
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

void print_table(const Advice& advice) {
  constexpr double kShownFactor = 25.0;
  const double best_ohm = advice.loads[advice.best].load_ohm;
  fmt::print("{:>12}{:>12}{:>12}{:>12}{:>12}\n", "load", "mean", "median", "95 %", "worst");
  for (const LoadChoice& choice : advice.loads) {
    if (std::abs(std::log(choice.load_ohm / best_ohm)) > std::log(kShownFactor)) continue;
    const std::string mark = choice.load_ohm == best_ohm ? "   best" : "";
    if (!choice.precision) {
      fmt::print("{:>12}   readings beyond the ADC or without a solution\n", ohm_text(choice.load_ohm));
      continue;
    }
    const Precision& precision = *choice.precision;
    fmt::print("{:>12}{:>12}{:>12}{:>12}{:>12}{}\n", ohm_text(choice.load_ohm), percent(precision.mean),
               percent(precision.median), percent(precision.p95), percent(precision.worst), mark);
  }
}

void print_text(const ArrayDescription& array, const AdviseOptions& options, double noise_ratio, const Advice& advice) {
  const Readout& readout = array.readout;
  const LoadChoice& best = advice.loads[advice.best];
  fmt::print("{} x {} taxels of {} to {}, {}, drivers of {}, noise of a reading {} of the supply.\n", array.rows,
             array.cols, ohm_text(options.range_ohm[0]), ohm_text(options.range_ohm[1]), circuit_text(readout),
             ohms_text(readout.drive_ohm), percent(noise_ratio));
  fmt::print("Relative 1-sigma of a conductance in one frame:\n\n");
  print_table(advice);
  fmt::print("\nLoad: take {} on every line: {}.\n", ohm_text(best.load_ohm), precision_text(best.precision));
  fmt::print("      Now, with {}: {}.\n", ohms_text(readout.load_ohm), precision_text(advice.present));
  if (!advice.ideal_drivers) {
    fmt::print("Drive: ideal drivers would bring readings beyond the ADC.\n");
    return;
  }
  fmt::print("Drive: the less the better. Ideal drivers: {}.\n", precision_text(advice.ideal_drivers));
  fmt::print("       Up to {} the mean grows by less than 10 %; now the drivers have {}.\n",
             ohm_text(advice.most_drive_ohm), ohms_text(readout.drive_ohm));
}

nlohmann::ordered_json precision_json(const std::optional<Precision>& precision) {
  if (!precision) return nullptr;
  return {
      {"mean", precision->mean}, {"median", precision->median}, {"p95", precision->p95}, {"worst", precision->worst}};
}

void print_json(const Advice& advice, double noise_ratio) {
  nlohmann::ordered_json json = {{"noise_ratio", noise_ratio},
                                 {"best_load_ohm", advice.loads[advice.best].load_ohm},
                                 {"best", precision_json(advice.loads[advice.best].precision)},
                                 {"present", precision_json(advice.present)},
                                 {"ideal_drivers", precision_json(advice.ideal_drivers)},
                                 {"most_drive_ohm", nullptr},
                                 {"loads", nlohmann::ordered_json::array()}};
  if (advice.ideal_drivers) json["most_drive_ohm"] = advice.most_drive_ohm;
  for (const LoadChoice& choice : advice.loads) {
    json["loads"].push_back({{"load_ohm", choice.load_ohm}, {"precision", precision_json(choice.precision)}});
  }
  fmt::print("{}\n", json.dump(2));
}

}  // namespace

Status circuit_advise(const AdviseOptions& options) {
  const double least_ohm = options.range_ohm[0];
  const double most_ohm = options.range_ohm[1];
  constexpr double kMostOhm = 1e12;
  if (!(least_ohm > 0.0 && least_ohm < most_ohm && most_ohm <= kMostOhm)) {
    return bad_input("--range: must be two resistances of a taxel in ohm, more than 0, the least first");
  }
  const Result<ArrayDescription> array = read_known_circuit(options.array);
  if (!array) return array.error();
  const Result<double> noise = adc_noise_ratio(*array);
  if (!noise) return in_file(options.array, noise.error());
  Progress progress;
  const Result<Advice> advice =
      advise(*array, least_ohm, most_ohm, *noise, [&](double share) { progress.show("advice", share); });
  progress.show("advice", 1.0);
  if (!advice) return in_file(options.array, advice.error());
  options.json ? print_json(*advice, *noise) : print_text(*array, options, *noise, *advice);
  return Done{};
}

}  // namespace dermis::app
