// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/calibration/calibrate.hpp"
#include "dermis/simulation/simulator.hpp"
#include "need.hpp"

namespace dermis {

/// Of the array whose scene is simulated to its end.
inline pipeline::Model calibrated_model(const ArrayDescription& array, simulation::Simulator& simulator) {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;
  RawFrame frame;
  while (need(simulator.next(frame))) {
    frames.push_back(frame);
    loads.insert(loads.end(), simulator.loads().begin(), simulator.loads().end());
  }
  return need(calibration::calibrate(array, frames, loads)).model;
}

}  // namespace dermis
