// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/network/levenberg_marquardt.hpp"

namespace dermis::network {

/// The largest deviation of a Jacobian from central finite differences, whose relative step is cbrt(epsilon). It is the
/// maximum over all entries of |J - J_fd| / max(1, |J|, |J_fd|). A correct Jacobian of a smooth function stays below
/// 1e-7. Infinite if an entry is not finite.
[[nodiscard]] double jacobian_deviation(const ResidualFunction& residual_function, std::size_t residual_count,
                                        std::span<const double> parameters);

}  // namespace dermis::network
