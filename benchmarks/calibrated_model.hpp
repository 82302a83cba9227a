// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/simulation/simulator.hpp"
#include "need.hpp"

namespace dermis {

/// Of the array whose scene is simulated to its end.
inline touch::pipeline::Model calibrated_model(const ArrayDescription& array, learn::simulation::Simulator& simulator) {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;
  RawFrame frame;
  while (need(simulator.next(frame))) {
    frames.push_back(frame);
    loads.insert(loads.end(), simulator.loads().begin(), simulator.loads().end());
  }
  return need(learn::calibration::calibrate(array, frames, loads)).model;
}

}  // namespace dermis
