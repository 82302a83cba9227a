// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::calibration {

/// A model for an array that is still to be calibrated, so that it can be shown meanwhile. No taxel has a force
/// (TaxelStatus::dead). Where the circuit is unknown, readings are taken as proportional to conductance; where they are
/// forces already, it is touch::pipeline::direct_model(). `array` must be valid. Not to be written to a file.
[[nodiscard]] touch::pipeline::Model uncalibrated_model(const ArrayDescription& array);

/// Whether no taxel of the model has a force: its array is still to be calibrated.
[[nodiscard]] bool is_uncalibrated(const touch::pipeline::Model& model);

}  // namespace dermis::learn::calibration
