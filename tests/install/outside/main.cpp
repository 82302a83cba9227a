// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cmath>
#include <cstdio>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/touch/frames/version.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"

// Calibrates a simulated array of 4 x 4 taxels and prints the newtons of one more frame.
int main() {
  dermis::ArrayDescription array;
  array.rows = 4;
  array.cols = 4;
  array.readout.drive_ohm.assign(array.rows, 20.0);
  array.readout.load_ohm.assign(array.cols, 200.0);

  std::vector<dermis::RawFrame> frames;
  std::vector<dermis::Load> loads;
  const auto rig = dermis::learn::simulation::Simulator::create(array, {}, "calibration", 1);
  if (!rig) return 1;
  dermis::RawFrame frame;
  for (auto more = (*rig)->next(frame); more && *more; more = (*rig)->next(frame)) {
    frames.push_back(frame);
    loads.insert(loads.end(), (*rig)->loads().begin(), (*rig)->loads().end());
  }
  const auto calibration = dermis::learn::calibration::calibrate(array, frames, loads);
  if (!calibration) return 1;

  auto pipeline = dermis::touch::pipeline::Pipeline::create(calibration->model);
  if (!pipeline) return 1;
  dermis::ForceFrame force;
  pipeline->process(frames.back(), force);
  const double expected = loads.back().value;
  const double found =
      static_cast<double>(force.newtons[array.index(loads.back().where.first_row, loads.back().where.first_col)]);
  std::printf("dermis %s: %.2f N, applied %.2f N\n", DERMIS_VERSION, found, expected);
  return std::abs(found - expected) < 0.05 * expected ? 0 : 1;
}
