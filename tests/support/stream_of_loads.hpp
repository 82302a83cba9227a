// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::support {

/// A pipeline at work on a simulated array of known material: 20 frames a second, 16 bit, one count of noise.
class StreamOfLoads {
 public:
  StreamOfLoads(std::size_t rows, std::size_t cols)
      : model_(digital(hand_made_model(rows, cols))),
        material_(model_),
        circuit_(*learn::simulation::ReadoutCircuit::create(model_.array)),
        pipeline_(touch::pipeline::Pipeline::create(model_).value()) {}

  [[nodiscard]] const touch::pipeline::Model& model() const { return model_; }
  [[nodiscard]] touch::pipeline::Pipeline& pipeline() { return pipeline_; }

  /// Since its calibration the array conducts so many times as much where nothing presses.
  void age_unloaded(double factor) {
    for (double& offset : material_.networks.unloaded.offset_siemens) offset *= factor;
  }

  /// Loads the taxels for so long; returns the forces of the last frame.
  std::vector<double> process(const std::vector<double>& newtons, double seconds,
                              const std::function<void(const ForceFrame&)>& see = {}) {
    std::vector<double> siemens(newtons.size());
    std::vector<double> ratio(newtons.size());
    for (std::size_t k = 0; k < newtons.size(); ++k) siemens[k] = siemens_under(material_, k, newtons[k], kCelsius);
    circuit_.ratios(siemens, ratio);
    RawFrame raw{.temperature_celsius = kCelsius, .supply_v = 5.0, .counts = std::vector<float>(newtons.size())};
    for (const Nanos end = time_ + Nanos(static_cast<std::int64_t>(1e9 * seconds)); time_ < end; time_ += kInterval) {
      raw.time = time_;
      learn::simulation::Adc(model_.array.readout, 1.0).convert(ratio, 5.0, random_, raw.counts);
      pipeline_.process(raw, force_);
      if (see) see(force_);
    }
    return {force_.newtons.begin(), force_.newtons.end()};
  }

 private:
  static constexpr Nanos kInterval = std::chrono::milliseconds(50);
  static constexpr double kCelsius = 25.0;

  static touch::pipeline::Model digital(touch::pipeline::Model model) {
    model.array.readout.adc_bits = 16;
    return model;
  }

  touch::pipeline::Model model_;
  touch::pipeline::Model material_;
  learn::simulation::ReadoutCircuit circuit_;
  touch::pipeline::Pipeline pipeline_;
  Random random_{1};
  Nanos time_{};
  ForceFrame force_;
};

}  // namespace dermis::support
