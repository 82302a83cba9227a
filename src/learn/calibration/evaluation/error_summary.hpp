// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <vector>

namespace dermis::learn::calibration {

/// |estimate / truth - 1|
[[nodiscard]] double relative_error(double estimate, double truth);

/// Empty where there are no errors.
[[nodiscard]] std::optional<double> root_mean_square(const std::vector<double>& errors);

}  // namespace dermis::learn::calibration
