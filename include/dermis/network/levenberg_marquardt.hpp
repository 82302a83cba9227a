// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "dermis/network/feed_forward.hpp"

namespace dermis::network {

/// Fills `residuals` [m] and, where it is not empty, `jacobian` [m, n] (row-major, d residual / d parameter) at
/// `parameters` [n].
using ResidualFunction =
    std::function<void(std::span<const double> parameters, std::span<double> residuals, std::span<double> jacobian)>;

/// Called after each iteration with its number from 1, the error of the best point so far, which is what the parameters
/// being minimised then hold, and the damping of the next: with it as initial_damping and from these parameters,
/// another call goes on as this one would. false stops.
using LevenbergMarquardtObserver = std::function<bool(int iteration, double error, double damping)>;

/// Errors are those of eq. (6) of the paper: half the sum of squares.
struct LevenbergMarquardtOptions {
  int max_iterations = 200;          ///< Accepted or refused steps, >= 1.
  double error_goal = 0.0;           ///< Stop at an error this small, >= 0.
  double gradient_limit = 0.0;       ///< Stop where no |dE/dparameter| is greater, >= 0.
  double relative_reduction = 1e-9;  ///< Stop when a step lowers the error by at most this share, >= 0; 0: never.
  double initial_damping = 1e-2;     ///< mu at the start, relative to the diagonal of J^T J, > 0.
  LevenbergMarquardtObserver observer = {};  ///< May be empty.
};

enum class LevenbergMarquardtStop : std::uint8_t {
  error_goal,
  gradient_limit,
  relative_reduction,
  no_descent,      ///< No step goes down, however short.
  max_iterations,  ///< This and what follows: not converged.
  observer,        ///< It said so.
  not_finite,      ///< The error of the start, or a derivative on the way.
};

struct LevenbergMarquardtReport {
  double initial_error = 0.0;
  double final_error = 0.0;
  int iterations = 0;
  LevenbergMarquardtStop stop = LevenbergMarquardtStop::max_iterations;

  [[nodiscard]] bool converged() const noexcept { return stop < LevenbergMarquardtStop::max_iterations; }
};

/// Minimises half the sum of `residual_count` squared residuals over `parameters`, in place; the best point seen is
/// kept, and a point with a residual that is not finite is never accepted. Marquardt's scaling: (J^T J + mu
/// diag(J^T J)) step = -J^T r, mu divided by 10 after a good step and multiplied by 10 after a bad one.
/// Levenberg 1944, Marquardt 1963. Thread-safe.
LevenbergMarquardtReport minimise(const ResidualFunction& residual_function, std::size_t residual_count,
                                  std::vector<double>& parameters, const LevenbergMarquardtOptions& options = {});

/// The same for the weighted error of a network over samples, eq. (6): Hagan and Menhaj 1994. The Jacobian is never
/// stored. `parameters` [network.shape().parameter_count()].
LevenbergMarquardtReport minimise(FeedForward<double>& network, const PackedSamples<double>& samples,
                                  std::vector<double>& parameters, const LevenbergMarquardtOptions& options = {});

/// Mean square of the first `data_count` residuals, each as it would be with its own datum left out of the fit:
/// r_j / (1 - h_j), h_j <= 0.95 the leverage from the linearised problem at `parameters` (all residuals, a penalty's
/// rows included, shape the normal matrix). data_count >= 1 and at least one parameter. Allen 1974 (PRESS), without a
/// single refit. Thread-safe.
[[nodiscard]] double leave_one_out_mean_square(const ResidualFunction& residual_function, std::size_t data_count,
                                               std::size_t residual_count, std::span<const double> parameters);

}  // namespace dermis::network
