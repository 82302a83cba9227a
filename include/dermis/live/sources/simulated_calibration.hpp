// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/bytes/devices/source_uri.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::sources {

/// An array with the loads from which it can be calibrated.
struct SimulatedCalibration {
  ArrayDescription array;
  std::vector<RawFrame> frames{};
  std::vector<Load> loads{};
};

/// The scene "uniform" on the array and the material of the URI of a simulation, whatever its own scene. Of all scenes
/// for calibrations it has the fewest frames. Fails where open_source() refuses that array or that material.
[[nodiscard]] Result<SimulatedCalibration> simulate_calibration(const bytes::devices::SourceUri& uri);

}  // namespace dermis::live::sources
