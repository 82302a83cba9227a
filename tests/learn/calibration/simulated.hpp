// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "support/reference_array.hpp"

namespace dermis::learn::calibration {

using support::reference_array;

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

}  // namespace dermis::learn::calibration
