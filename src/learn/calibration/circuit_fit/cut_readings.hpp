// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "learn/calibration/circuit_fit/circuit_frames.hpp"

namespace dermis::learn::calibration {

/// Ratio to the supply below which the mean of a frame cannot be trusted. An ADC cuts its readings at 0, so near 0
/// their mean is above the value of the circuit. 0 for single frames, whose noise is known. A mean says too little
/// about the noise with which its readings were cut.
[[nodiscard]] double trusted_above(const CircuitFrame& frame);

/// The mean of max(cut, x), where x is normal with `mean` and `sigma` > 0.
[[nodiscard]] double mean_above(double cut, double mean, double sigma);

}  // namespace dermis::learn::calibration
