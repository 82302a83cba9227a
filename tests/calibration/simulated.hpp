// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/loads.hpp"
#include "dermis/simulation/simulator.hpp"

namespace dermis::calibration {

/// The reference array of the design, of any size.
inline ArrayDescription reference_array(std::size_t rows, std::size_t cols) {
  ArrayDescription array;
  array.rows = rows;
  array.cols = cols;
  array.taxel_area_m2 = simulation::kPaperDiscAreaM2;
  array.readout.drive_ohm.assign(rows, 20.0);
  array.readout.load_ohm.assign(cols, 200.0);
  array.readout.adc_reference_v = 5.0;
  array.readout.supply_v = 5.0;
  return array;
}

struct Recording {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;
};

/// All frames of a scene and their labels.
inline Recording record(simulation::Simulator& simulator) {
  Recording recording;
  RawFrame frame;
  while (simulator.next(frame).value()) {
    recording.frames.push_back(frame);
    const std::vector<Load>& loads = simulator.loads();
    recording.loads.insert(recording.loads.end(), loads.begin(), loads.end());
  }
  return recording;
}

inline std::unique_ptr<simulation::Simulator> simulate(const ArrayDescription& array, const std::string& scene,
                                                       std::uint64_t seed,
                                                       const simulation::SimulationOptions& options = {},
                                                       std::optional<std::size_t> frames = {}) {
  auto simulator = simulation::Simulator::create(array, options, scene, seed, frames);
  EXPECT_TRUE(simulator) << simulator.error().message;
  return std::move(*simulator);
}

inline Recording record(const ArrayDescription& array, const std::string& scene, std::uint64_t seed,
                        const simulation::SimulationOptions& options = {}, std::optional<std::size_t> frames = {}) {
  return record(*simulate(array, scene, seed, options, frames));
}

}  // namespace dermis::calibration
