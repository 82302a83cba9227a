// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/bytes/devices/source_uri.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::out::serve {

/// An array that can be served and calibrated, whether it was calibrated before or not.
struct ModelOrArray {
  touch::pipeline::Model model;  ///< learn::calibration::uncalibrated_model() of an array without one.
  ArrayDescription array;        ///< As a calibration takes it: parts of the circuit may still be unknown.
};

/// A model file, or an array.toml (by its ending .toml).
[[nodiscard]] Result<ModelOrArray> read_model_or_array(const std::string& path);

/// The array that a recording describes, with the model in it, if there is one. Fails where it describes none.
[[nodiscard]] Result<ModelOrArray> read_recorded_array(const std::string& recording);

/// The array of a simulation, calibrated by loads that are simulated.
[[nodiscard]] Result<ModelOrArray> calibrate_simulated_array(const bytes::devices::SourceUri& uri);

}  // namespace dermis::out::serve
