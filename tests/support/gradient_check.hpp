// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "dermis/touch/network/levenberg_marquardt.hpp"

namespace dermis::support {

/// The largest deviation of a Jacobian from central finite differences, whose relative step is cbrt(epsilon). It is the
/// maximum over all entries of |J - J_fd| / max(1, |J|, |J_fd|). A correct Jacobian of a smooth function stays below
/// 1e-7. Infinite if an entry is not finite.
inline double jacobian_deviation(const touch::network::ResidualFunction& residual_function, std::size_t residual_count,
                                 std::span<const double> parameters) {
  const std::size_t n = parameters.size();
  std::vector<double> point(parameters.begin(), parameters.end());
  std::vector<double> residuals(residual_count);
  std::vector<double> jacobian(residual_count * n);
  residual_function(point, residuals, jacobian);

  const double relative_step = std::cbrt(std::numeric_limits<double>::epsilon());
  std::vector<double> above(residual_count);
  std::vector<double> below(residual_count);
  double deviation = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double step = relative_step * std::max(1.0, std::abs(point[k]));
    const double centre = point[k];
    point[k] = centre + step;
    residual_function(point, above, {});
    point[k] = centre - step;
    residual_function(point, below, {});
    point[k] = centre;
    for (std::size_t i = 0; i < residual_count; ++i) {
      const double analytic = jacobian[i * n + k];
      const double numeric = (above[i] - below[i]) / (2.0 * step);
      if (!std::isfinite(analytic) || !std::isfinite(numeric)) return std::numeric_limits<double>::infinity();
      const double scale = std::max({1.0, std::abs(analytic), std::abs(numeric)});
      deviation = std::max(deviation, std::abs(analytic - numeric) / scale);
    }
  }
  return deviation;
}

}  // namespace dermis::support
