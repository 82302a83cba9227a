// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/core/array_description.hpp"
#include "dermis/core/result.hpp"

namespace dermis::app {

/// An array of a file, with a circuit that can be computed.
[[nodiscard]] Result<ArrayDescription> read_known_circuit(const std::string& path);

/// Standard deviation of a reading over the supply by the noise of the ADC. Errors: a reference in volts without a
/// nominal supply.
[[nodiscard]] Result<double> adc_noise_ratio(const ArrayDescription& array);

/// The error with the name of the file before it.
[[nodiscard]] Error in_file(const std::string& path, const Error& error);

}  // namespace dermis::app
