// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/findings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dermis/touch/fusion/force_fusion.hpp"

namespace dermis::learn::health {
namespace {

constexpr double kMuchNoise = 1.5;           // times what the model says
constexpr double kMuchOffsetDrift = 0.3;     // of the unloaded conductance, of few taxels
constexpr double kCommonOffsetDrift = 0.15;  // and where many have moved alike
constexpr double kMuchSaturation = 0.01;     // of all readings
constexpr double kTemperatureMargin = 1.0;   // sensor noise [C]

bool leaves_calibrated_range(const TemperatureRange& temperature, const touch::fusion::ForceNetworks& networks) {
  if (networks.shape.inputs != touch::fusion::kInputsWithTemperature) return false;
  const TemperatureSpan& calibrated = networks.unloaded.temperature;
  const double half_span = calibrated.half_span_celsius + kTemperatureMargin;
  return temperature.coldest_celsius < calibrated.centre_celsius - half_span ||
         temperature.hottest_celsius > calibrated.centre_celsius + half_span;
}

bool leaves_trusted_range(const touch::preprocessing::SupplyRange& supply, const touch::pipeline::Model& model) {
  const touch::preprocessing::SupplyRange trusted =
      touch::preprocessing::SupplyBounds(model.array.readout, model.supply).trusted();
  return !trusted.contains(supply.least_v) || !trusted.contains(supply.most_v);
}

/// Many taxels tell less, if most have moved the same way: memory and touches move some.
bool has_drifted(const Diagnosis& diagnosis) {
  if (!diagnosis.offset_drift) return false;
  const double drift = std::abs(*diagnosis.offset_drift);
  const bool is_common = diagnosis.offset_spread && drift > 2.0 * *diagnosis.offset_spread;
  return drift > (is_common ? kCommonOffsetDrift : kMuchOffsetDrift);
}

bool is_same(const FaultHistory& a, const FaultHistory& b) {
  return a.fault.kind == b.fault.kind && a.fault.place == b.fault.place;
}

/// A fault that comes and goes is one, which was found several times.
std::vector<FaultHistory> joined(const std::vector<FaultHistory>& faults) {
  std::vector<FaultHistory> joined;
  for (const FaultHistory& next : faults) {
    const auto known =
        std::find_if(joined.begin(), joined.end(), [&](const FaultHistory& other) { return is_same(other, next); });
    if (known == joined.end()) {
      joined.push_back(next);
    } else {
      known->until = next.until;
      ++known->times;
    }
  }
  return joined;
}

void add_findings_of_frames(const Diagnosis& diagnosis, std::vector<std::string>& found) {
  if (diagnosis.frames == diagnosis.frames_rejected) found.emplace_back("no frame could be used");
  if (diagnosis.frames_unsolved > 0) {
    found.push_back(fmt::format("{} frames do not fit the circuit of the array: check readout in array.toml",
                                diagnosis.frames_unsolved));
  }
  for (const auto& [reason, count] : diagnosis.rejections) {
    found.push_back(fmt::format("{} frames rejected: {}", count, reason));
  }
  if (!diagnosis.missing_readings.empty()) {
    found.push_back(diagnosis.missing_readings + ": no force there, the others are solved");
  }
}

void add_findings_of_readings(const Diagnosis& diagnosis, const ArrayDescription& array,
                              std::vector<std::string>& found) {
  if (diagnosis.noise_counts && *diagnosis.noise_counts > kMuchNoise * array.readout.adc_noise_counts) {
    found.push_back(fmt::format(
        "the readings have {:.1f} counts of noise or hum, {:.1f} times what was calibrated: check grounding "
        "and supply",
        *diagnosis.noise_counts, *diagnosis.noise_counts / array.readout.adc_noise_counts));
  }
  if (diagnosis.saturated_share > kMuchSaturation) {
    found.push_back(fmt::format("{:.1f} % of the readings stand at the end of the ADC: forces there are lower bounds",
                                100.0 * diagnosis.saturated_share));
  }
}

void add_findings_of_calibration(const Diagnosis& diagnosis, const touch::pipeline::Model& model,
                                 std::vector<std::string>& found) {
  if (has_drifted(diagnosis)) {
    found.push_back(
        fmt::format("unloaded taxels conduct {:+.0f} % against the calibration: tare, check with a known weight, and "
                    "recalibrate or calibrate again if that is off",
                    100.0 * *diagnosis.offset_drift));
  }
  if (diagnosis.ageing.has_aged()) found.push_back(describe(diagnosis.ageing));
  if (diagnosis.temperature && leaves_calibrated_range(*diagnosis.temperature, model.networks)) {
    found.emplace_back("the temperature leaves the calibrated range: forces there are those at its end");
  }
  if (diagnosis.supply && leaves_trusted_range(*diagnosis.supply, model)) {
    found.emplace_back(
        "the supply leaves the calibrated range: forces are less sure; check its meter, or calibrate there");
  }
  const auto doubts = model.provenance.find(touch::pipeline::kDoubts);
  if (doubts != model.provenance.end()) found.push_back("since the calibration: " + doubts->second);
}

}  // namespace

std::vector<std::string> findings_of(const Diagnosis& diagnosis, const touch::pipeline::Model& model) {
  const ArrayDescription& array = model.array;
  std::vector<std::string> found;
  for (const FaultHistory& history : joined(diagnosis.faults)) {
    found.push_back(place_name(history.fault, array) + " " + describe(history, array));
  }
  add_findings_of_frames(diagnosis, found);
  add_findings_of_readings(diagnosis, array, found);
  add_findings_of_calibration(diagnosis, model, found);
  return found;
}

std::vector<std::string> remarks_on(std::span<const touch::compensation::LineFault> suspicions,
                                    const ArrayDescription& array) {
  std::vector<std::string> remarks;
  for (const touch::compensation::LineFault& suspicion : suspicions) {
    const bool shorted = traits_of(suspicion.kind).effect == touch::compensation::LineFaultEffect::shorted;
    remarks.push_back(fmt::format("{} may be shorted {}: some presses look like it; press {} in several places to tell",
                                  place_name(suspicion, array), shorted ? "together" : "to the supply",
                                  shorted ? "each of them" : "it and other rows"));
  }
  return remarks;
}

}  // namespace dermis::learn::health
