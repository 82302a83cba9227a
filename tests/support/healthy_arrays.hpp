// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/compensation/line_faults.hpp"
#include "dermis/touch/frames/random.hpp"
#include "learn/calibration/robust_line.hpp"
#include "support/circuits.hpp"

/// Random arrays without a fault, watched for faults.
namespace dermis::support {

/// An array, what it is made of and what happens to it.
struct HealthyArray {
  ArrayDescription array;
  learn::simulation::SimulationOptions options;
  std::string scene;
  std::uint64_t seed = 0;
  double threshold_counts = 0.0;  ///< Readings below are sent as 0, as some vendors do.
  double loaded_share = 0.0;      ///< Of the frames whose mean was taken for the unloaded readings.
  bool shuffled = false;          ///< Frames come in any order.
  std::string words;
};

/// Half of the arrays have the memory of real rubber; a third are touched as hands do.
inline void give_memory_and_touches(std::uint64_t seed, HealthyArray& healthy) {
  Random random = Random::stream(seed, 1);
  learn::simulation::RubberOptions& rubber = healthy.options.rubber;
  if (random.below(2) == 0) {
    rubber.creep = rubber.hysteresis = 0.0;
    rubber.memory = learn::simulation::RubberMemoryOptions{.creep_per_decade = random.uniform(0.02, 0.3),
                                                           .loop_gap = random.uniform(0.0, 0.2),
                                                           .touch_gain = random.uniform(0.0, 0.3),
                                                           .release_dip = random.uniform(0.0, 0.6)};
  }
  if (random.below(3) == 0) healthy.scene = "touches";
}

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
  learn::simulation::RubberOptions& rubber = healthy.options.rubber;
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
  give_memory_and_touches(seed, healthy);
  const double full_scale = array.readout.full_scale_counts();
  healthy.threshold_counts = full_scale * one_of({0.0, 0.0, 0.005, 0.02, 0.05});
  healthy.loaded_share = one_of({0.0, 0.0, 0.1, 0.3});
  healthy.shuffled = random.below(3) == 0;
  healthy.words = circuit.name + ' ' + std::to_string(array.rows) + 'x' + std::to_string(array.cols) + ' ' +
                  std::to_string(array.readout.adc_bits) + " bit, noise " +
                  std::to_string(array.readout.adc_noise_counts) + ", " + healthy.scene + ", spread " +
                  std::to_string(rubber.resistance_spread) + (rubber.memory ? ", memory" : "") + ", threshold " +
                  std::to_string(healthy.threshold_counts) + ", loaded " + std::to_string(healthy.loaded_share) +
                  (healthy.shuffled ? ", shuffled" : "");
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
    const auto sent = static_cast<double>(count);
    frame.ratio.push_back(sent / full_scale);
    frame.taxels.push_back(sent >= full_scale ? TaxelStatus::saturated : TaxelStatus::ok);
  }
  return frame;
}

/// The scene on this array; `frames` where it has any length.
inline std::unique_ptr<learn::simulation::Simulator> play(const HealthyArray& healthy, const std::string& scene,
                                                          std::uint64_t seed, std::size_t frames) {
  constexpr double kTouchRateHz = 10.0;
  const bool has_any_length = scene == "multitouch" || scene == "contacts" || scene == "idle" || scene == "touches";
  learn::simulation::SimulationOptions options = healthy.options;
  if (learn::simulation::find_scene(scene)->pace == learn::simulation::ScenePace::any_rate)
    options.scene.rate_hz = kTouchRateHz;
  return learn::simulation::Simulator::create(healthy.array, options, scene, seed,
                                              has_any_length ? std::optional(frames) : std::nullopt)
      .value();
}

/// What the readout sends of a frame.
inline void cut_off(const HealthyArray& healthy, RawFrame& raw) {
  for (float& count : raw.counts) {
    if (static_cast<double>(count) < healthy.threshold_counts) count = 0.0F;
  }
}

/// At most `frames` of a scene.
inline std::vector<RawFrame> sent_frames(const HealthyArray& healthy, const std::string& scene, std::uint64_t seed,
                                         std::size_t frames) {
  const auto simulator = play(healthy, scene, seed, frames);
  std::vector<RawFrame> all;
  RawFrame raw;
  while (all.size() < frames && *simulator->next(raw)) {
    cut_off(healthy, raw);
    all.push_back(raw);
  }
  return all;
}

/// What happens to the array, in order or, the times aside, not.
inline std::vector<RawFrame> stream_of(const HealthyArray& healthy, std::size_t frames) {
  std::vector<RawFrame> stream = sent_frames(healthy, healthy.scene, healthy.seed, frames);
  Random random(healthy.seed);
  for (std::size_t k = stream.size(); healthy.shuffled && k-- > 1;) {
    const std::size_t other = random.below(k + 1);
    std::swap(stream[k], stream[other]);
    std::swap(stream[k].time, stream[other].time);
  }
  return stream;
}

/// Conductance in frames that were said to be unloaded, as a calibration takes it.
inline std::vector<double> calibrated_unloaded(const HealthyArray& healthy,
                                               touch::compensation::Compensator& compensator) {
  constexpr std::size_t kFrames = 40;
  auto frames = sent_frames(healthy, "idle", healthy.seed + 1, kFrames);
  const auto loaded = sent_frames(healthy, "contacts", healthy.seed + 2, 400);
  const auto replaced = static_cast<std::size_t>(healthy.loaded_share * kFrames);
  for (std::size_t k = 0; k < replaced; ++k) frames[k] = loaded[k * loaded.size() / replaced];
  const double counts =
      1.0 / (3.0 * healthy.array.readout.adc_noise_counts);  // a third of a count [standard deviations]
  std::vector<std::vector<learn::calibration::Point>> points(healthy.array.taxel_count());
  std::vector<double> sigma(points.size(), std::numeric_limits<double>::infinity());
  ConductanceFrame conductance;
  for (const RawFrame& frame : frames) {
    compensator.process(conditioned_frame(healthy, frame), conductance);
    for (std::size_t taxel = 0; taxel < points.size(); ++taxel) {
      points[taxel].push_back({0.0, conductance.siemens[taxel]});
      sigma[taxel] = std::min(sigma[taxel], conductance.sigma_siemens[taxel]);
    }
  }
  std::vector<double> unloaded;
  for (const auto& of_taxel : points) {
    unloaded.push_back(learn::calibration::fit_robust_line(of_taxel, false, counts * sigma[unloaded.size()]).level);
  }
  return unloaded;
}

/// Names the faults that mask taxels, each once: "silent_row row 3; ".
inline void name_faults(std::span<const touch::compensation::LineFault> faults, const ArrayDescription& array,
                        std::string& text) {
  for (const touch::compensation::LineFault& fault : faults) {
    if (masked_taxel_count(fault, array) == 0) continue;
    const std::string name = std::string(to_string(fault.kind)) + ' ' + place_name(fault, array) + "; ";
    if (text.find(name) == std::string::npos) text += name;
  }
}

/// The faults that are found within so many frames.
inline std::string found_faults(const HealthyArray& healthy, std::size_t frames) {
  touch::compensation::Compensator compensator = touch::compensation::Compensator::create(healthy.array).value();
  touch::compensation::LineFaultMonitor monitor(healthy.array, calibrated_unloaded(healthy, compensator));
  ConductanceFrame conductance;
  std::string text;
  for (const RawFrame& raw : stream_of(healthy, frames)) {
    const ConditionedFrame frame = conditioned_frame(healthy, raw);
    compensator.process(frame, conductance);
    if (!monitor.observe(frame, conductance)) continue;
    name_faults(monitor.faults(), healthy.array, text);
    compensator.set_faults(monitor.faults());
  }
  return text;
}

}  // namespace dermis::support
