// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/network/levenberg_marquardt.hpp"

namespace dermis::network {

/// The largest deviation of a Jacobian from central finite differences with a relative step of cbrt(epsilon):
/// max over all entries of |J - J_fd| / max(1, |J|, |J_fd|). A right Jacobian of a smooth function stays below 1e-7;
/// infinite where an entry is not finite.
[[nodiscard]] double jacobian_deviation(const ResidualFunction& residual_function, std::size_t residual_count,
                                        std::span<const double> parameters);

}  // namespace dermis::network
