// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace dermis::network {

/// Fills `residuals` [m] and, where it is not empty, `jacobian` [m, n] (row-major, d residual / d parameter) at
/// `parameters` [n].
using ResidualFunction =
    std::function<void(std::span<const double> parameters, std::span<double> residuals, std::span<double> jacobian)>;

struct LevenbergMarquardtOptions {
  int max_iterations = 200;          ///< Accepted or refused steps, >= 1.
  double relative_reduction = 1e-9;  ///< Stop when an accepted step lowers the error by less than this share, > 0.
  double initial_damping = 1e-2;     ///< mu at the start, relative to the diagonal of J^T J, > 0.
};

struct LevenbergMarquardtReport {
  double initial_error = 0.0;  ///< Half the sum of squared residuals at the start, eq. (6) of the paper.
  double final_error = 0.0;
  int iterations = 0;
  bool converged = false;  ///< false: stopped at max_iterations, or the start itself is not finite.
};

/// Minimises half the sum of `residual_count` squared residuals over `parameters`, in place; the best point seen is
/// kept, and a point with a residual that is not finite is never accepted. Marquardt's scaling: (J^T J + mu
/// diag(J^T J)) step = -J^T r, mu divided by 10 after a good step and multiplied by 10 after a bad one.
/// Levenberg 1944, Marquardt 1963; Hagan and Menhaj 1994 for networks. Thread-safe.
LevenbergMarquardtReport minimise(const ResidualFunction& residual_function, std::size_t residual_count,
                                  std::vector<double>& parameters, const LevenbergMarquardtOptions& options = {});

/// Mean square of the first `data_count` residuals, each as it would be with its own datum left out of the fit:
/// r_j / (1 - h_j), h_j <= 0.95 the leverage from the linearised problem at `parameters` (all residuals, a penalty's
/// rows included, shape the normal matrix). data_count >= 1 and at least one parameter. Allen 1974 (PRESS), without a
/// single refit. Thread-safe.
[[nodiscard]] double leave_one_out_mean_square(const ResidualFunction& residual_function, std::size_t data_count,
                                               std::size_t residual_count, std::span<const double> parameters);

}  // namespace dermis::network
