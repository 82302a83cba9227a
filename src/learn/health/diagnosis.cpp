// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/diagnosis.hpp"

#include <fmt/core.h>

namespace dermis::learn::health {
namespace {

std::string frames_text(const Diagnosis& diagnosis) {
  std::string text =
      fmt::format("{}, {} rejected, {:.1f} s", diagnosis.frames, diagnosis.frames_rejected, diagnosis.seconds);
  if (!(diagnosis.seconds > 0.0)) return text;
  const std::size_t accepted = diagnosis.frames - diagnosis.frames_rejected;
  return text + fmt::format(", {:.1f} frames/s", static_cast<double>(accepted - 1) / diagnosis.seconds);
}

std::string temperature_text(const Diagnosis& diagnosis, const touch::pipeline::Model& model) {
  const std::string measured = diagnosis.temperature
                                   ? fmt::format("{:.1f} to {:.1f} C", diagnosis.temperature->coldest_celsius,
                                                 diagnosis.temperature->hottest_celsius)
                                   : "unknown";
  const TemperatureSpan& calibrated = model.networks.unloaded.temperature;
  if (calibrated.half_span_celsius == 0.0) return measured + ", unknown when calibrated";
  return measured + fmt::format(", calibrated {:.1f} to {:.1f} C",
                                calibrated.centre_celsius - calibrated.half_span_celsius,
                                calibrated.centre_celsius + calibrated.half_span_celsius);
}

std::string supply_text(const Diagnosis& diagnosis, const touch::pipeline::Model& model) {
  const auto text = [](const touch::preprocessing::SupplyRange& range) {
    return fmt::format("{:.2f} to {:.2f} V", range.least_v, range.most_v);
  };
  return text(*diagnosis.supply) + (model.supply ? ", calibrated " + text(*model.supply) : ", unknown when calibrated");
}

std::string unloaded_text(const Diagnosis& diagnosis) {
  if (!diagnosis.offset_drift) return "unknown";
  std::string text = fmt::format("{:+.1f} % against the calibration", 100.0 * *diagnosis.offset_drift);
  if (diagnosis.offset_spread) text += fmt::format(", {:.1f} % from taxel to taxel", 100.0 * *diagnosis.offset_spread);
  return text;
}

std::string gains_text(const AgeingEvidence& ageing) {
  if (!ageing.gain_spread) return "unknown (too few touches of several taxels)";
  return fmt::format("{:.1f} % from taxel to taxel against the calibration", 100.0 * *ageing.gain_spread);
}

}  // namespace

std::string describe(const Diagnosis& diagnosis, const touch::pipeline::Model& model) {
  const ArrayDescription& array = model.array;
  std::string text = fmt::format("array        {}, {} x {}, {}\n", array.name, array.rows, array.cols,
                                 to_string(array.readout.circuit));
  text += fmt::format("frames       {}\n", frames_text(diagnosis));
  text += fmt::format(
      "noise        {}, calibrated {:.2f} counts\n",
      diagnosis.noise_counts ? fmt::format("{:.2f} counts", *diagnosis.noise_counts) : "unknown (touched all the time)",
      array.readout.adc_noise_counts);
  text += fmt::format("saturated    {:.2f} % of all readings\n", 100.0 * diagnosis.saturated_share);
  text += fmt::format("unloaded     {}\n", unloaded_text(diagnosis));
  text += fmt::format("gains        {}\n", gains_text(diagnosis.ageing));
  text += fmt::format("temperature  {}\n", temperature_text(diagnosis, model));
  if (diagnosis.supply) text += fmt::format("supply       {}\n", supply_text(diagnosis, model));
  text += fmt::format("circuit      {} frames unsolved, worst misfit {:.2f} standard deviations\n",
                      diagnosis.frames_unsolved, diagnosis.worst_misfit_sigma);
  if (!diagnosis.blind_lines.empty()) {
    text += fmt::format("blind        {} of {} lines read too little unloaded for a break to be seen\n",
                        diagnosis.blind_lines.size(), array.rows + array.cols);
  }
  text += "\n";
  for (const std::string& finding : diagnosis.findings) text += finding + "\n";
  if (diagnosis.is_healthy()) text += "healthy\n";
  for (const std::string& remark : diagnosis.remarks) text += "remark: " + remark + "\n";
  return text;
}

}  // namespace dermis::learn::health
