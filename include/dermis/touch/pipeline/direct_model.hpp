// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::touch::pipeline {

/// The model of an array whose readings another system has calibrated (readout.quantity: pressures or forces): a
/// reading is its force, with nothing uncertain but readout.adc_noise_counts. One count is 1 N for an array whose
/// readings are counts. `array` must be valid.
[[nodiscard]] Model direct_model(const ArrayDescription& array);

}  // namespace dermis::touch::pipeline
