// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/robust_line.hpp"
#include "dermis/compensation/crosstalk.hpp"
#include "dermis/compensation/line_faults.hpp"
#include "dermis/core/random.hpp"
#include "dermis/simulation/simulator.hpp"
#include "support/circuits.hpp"

/// Random arrays without a fault, watched for faults.
namespace dermis::support {

/// An array, what it is made of and what happens to it.
struct HealthyArray {
  ArrayDescription array;
  simulation::SimulationOptions options;
  std::string scene;
  std::uint64_t seed = 0;
  double threshold_counts = 0.0;  ///< Readings below are sent as 0, as some vendors do.
  double loaded_share = 0.0;      ///< Of the frames whose mean was taken for the unloaded readings.
  bool shuffled = false;          ///< Frames come in any order.
  std::string words;
};

inline HealthyArray random_healthy_array(std::uint64_t seed) {
  Random random(seed);
  const auto one_of = [&](std::initializer_list<double> values) { return values.begin()[random.below(values.size())]; };
  std::vector<NamedCircuit> circuits = all_circuits();
  circuits.push_back({"none", Circuit::none});
  circuits.push_back({"none", Circuit::none});
  const NamedCircuit& circuit = circuits[random.below(circuits.size())];
  HealthyArray healthy;
  healthy.seed = seed;
  ArrayDescription& array = healthy.array;
  array = random_array(circuit, 1 + random.below(16), 2 + random.below(15), random);
  array.taxel_area_m2 = 38.48e-6;
  array.readout.adc_bits = static_cast<int>(one_of({8, 10, 12, 16}));
  healthy.options.environment.adc_noise_lsb = random.log_uniform(0.05, 2.0);
  array.readout.adc_noise_counts = std::hypot(healthy.options.environment.adc_noise_lsb, std::sqrt(1.0 / 12));
  simulation::RubberOptions& rubber = healthy.options.rubber;
  rubber.seed = seed;
  rubber.resistance_at_10n_ohm = random.log_uniform(200.0, 2e4);
  rubber.unloaded_ohm = rubber.resistance_at_10n_ohm * random.log_uniform(20.0, 2e3);
  rubber.exponent = random.uniform(0.5, 1.2);
  rubber.resistance_spread = one_of({0.0, 0.05, 0.25, 0.5});
  rubber.exponent_spread = rubber.resistance_spread > 0.0 ? 0.05 : 0.0;
  if (random.below(2) == 0) {
    rubber.creep = 0.1;
    rubber.hysteresis = 0.2;
    rubber.pink_noise = 1e-5;
  }
  rubber.mechanical_spread = one_of({0.0, 0.0, 0.2});
  const char* const scenes[] = {"multitouch", "contacts", "uniform", "idle", "calibration"};
  healthy.scene = scenes[random.below(std::size(scenes))];
  const double full_scale = array.readout.full_scale_counts();
  healthy.threshold_counts = full_scale * one_of({0.0, 0.0, 0.005, 0.02, 0.05});
  healthy.loaded_share = one_of({0.0, 0.0, 0.1, 0.3});
  healthy.shuffled = random.below(3) == 0;
  healthy.words = circuit.name + ' ' + std::to_string(array.rows) + 'x' + std::to_string(array.cols) + ' ' +
                  std::to_string(array.readout.adc_bits) + " bit, noise " +
                  std::to_string(array.readout.adc_noise_counts) + ", " + healthy.scene + ", spread " +
                  std::to_string(rubber.resistance_spread) + ", threshold " + std::to_string(healthy.threshold_counts) +
                  ", loaded " + std::to_string(healthy.loaded_share) + (healthy.shuffled ? ", shuffled" : "");
  return healthy;
}

/// Unit 2 where the ADC measures against the supply.
inline ConditionedFrame conditioned_frame(const HealthyArray& healthy, const RawFrame& raw) {
  const Readout& readout = healthy.array.readout;
  const double full_scale = readout.full_scale_counts();
  ConditionedFrame frame;
  frame.time = raw.time;
  frame.sigma_ratio = readout.adc_noise_counts / full_scale;
  for (const float count : raw.counts) {
    const double sent = static_cast<double>(count) < healthy.threshold_counts ? 0.0 : static_cast<double>(count);
    frame.ratio.push_back(sent / full_scale);
    frame.taxels.push_back(sent >= full_scale ? TaxelStatus::saturated : TaxelStatus::ok);
  }
  return frame;
}

/// At most `frames` of a scene, fixed ones from anywhere in it.
inline std::vector<ConditionedFrame> frames_of(const HealthyArray& healthy, const std::string& scene,
                                               std::uint64_t seed, std::size_t frames) {
  const bool has_any_length = scene == "multitouch" || scene == "contacts" || scene == "idle";
  std::optional<std::size_t> length;
  if (has_any_length) length = frames;
  const auto simulator = simulation::Simulator::create(healthy.array, healthy.options, scene, seed, length).value();
  std::vector<ConditionedFrame> all;
  RawFrame raw;
  while (all.size() < frames && *simulator->next(raw)) all.push_back(conditioned_frame(healthy, raw));
  return all;
}

/// Conductance in frames that were said to be unloaded, as a calibration takes it.
inline std::vector<double> calibrated_unloaded(const HealthyArray& healthy, compensation::Compensator& compensator) {
  constexpr std::size_t kFrames = 40;
  auto frames = frames_of(healthy, "idle", healthy.seed + 1, kFrames);
  const auto loaded = frames_of(healthy, "contacts", healthy.seed + 2, 400);
  const auto replaced = static_cast<std::size_t>(healthy.loaded_share * kFrames);
  for (std::size_t k = 0; k < replaced; ++k) frames[k] = loaded[k * loaded.size() / replaced];
  const double counts =
      1.0 / (3.0 * healthy.array.readout.adc_noise_counts);  // a third of a count [standard deviations]
  std::vector<std::vector<calibration::Point>> points(healthy.array.taxel_count());
  std::vector<double> sigma(points.size(), std::numeric_limits<double>::infinity());
  ConductanceFrame conductance;
  for (const ConditionedFrame& frame : frames) {
    compensator.process(frame, conductance);
    for (std::size_t taxel = 0; taxel < points.size(); ++taxel) {
      points[taxel].push_back({0.0, conductance.siemens[taxel]});
      sigma[taxel] = std::min(sigma[taxel], conductance.sigma_siemens[taxel]);
    }
  }
  std::vector<double> unloaded;
  for (const auto& of_taxel : points) {
    unloaded.push_back(calibration::fit_robust_line(of_taxel, false, counts * sigma[unloaded.size()]).level);
  }
  return unloaded;
}

/// The faults that are found within so many frames, as text: "silent_row row 3; ".
inline std::string found_faults(const HealthyArray& healthy, std::size_t frames) {
  compensation::Compensator compensator = compensation::Compensator::create(healthy.array).value();
  compensation::LineFaultMonitor monitor(healthy.array, calibrated_unloaded(healthy, compensator));
  std::vector<ConditionedFrame> stream = frames_of(healthy, healthy.scene, healthy.seed, frames);
  Random random(healthy.seed);
  for (std::size_t k = stream.size(); healthy.shuffled && k-- > 1;) std::swap(stream[k], stream[random.below(k + 1)]);
  ConductanceFrame conductance;
  std::string text;
  for (const ConditionedFrame& frame : stream) {
    compensator.process(frame, conductance);
    if (!monitor.observe(frame, conductance)) continue;
    for (const compensation::LineFault& fault : monitor.faults()) {
      if (masked_taxel_count(fault, healthy.array) == 0) continue;
      const std::string name = std::string(to_string(fault.kind)) + ' ' + place_name(fault, healthy.array) + "; ";
      if (text.find(name) == std::string::npos) text += name;
    }
    compensator.set_faults(monitor.faults());
  }
  return text;
}

}  // namespace dermis::support
