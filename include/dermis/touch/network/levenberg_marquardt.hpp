// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace dermis::touch::network {

/// Fills `residuals` [m] at `parameters` [n]. Also fills `jacobian` [m, n] (row-major, d residual / d parameter) if it
/// is not empty.
using ResidualFunction =
    std::function<void(std::span<const double> parameters, std::span<double> residuals, std::span<double> jacobian)>;

/// A sum of squares that need not store its Jacobian J.
class LeastSquaresProblem {
 public:
  LeastSquaresProblem() = default;
  LeastSquaresProblem(const LeastSquaresProblem&) = delete;
  LeastSquaresProblem& operator=(const LeastSquaresProblem&) = delete;
  virtual ~LeastSquaresProblem() = default;

  /// Half the sum of squares at `point` [n].
  virtual double error(std::span<const double> point) = 0;

  /// Its gradient in `gradient` [n] and J^T J in `normal` [n, n], of which only the lower triangle is read.
  virtual void linearise(std::span<const double> point, std::span<double> gradient, std::span<double> normal) = 0;
};

/// Called after each iteration with its number (from 1), the error of the best point so far and the next damping. The
/// parameters being minimised then hold that point. Another call from these parameters, with that damping as
/// initial_damping, continues as this one would. false stops.
using LevenbergMarquardtObserver = std::function<bool(int iteration, double error, double damping)>;

/// Errors are those of eq. (6) of the paper: half the sum of squares.
struct LevenbergMarquardtOptions {
  int max_iterations = 200;          ///< Accepted or refused steps, >= 1.
  double error_goal = 0.0;           ///< Stop at an error this small, >= 0.
  double gradient_limit = 0.0;       ///< Stop if no |dE/dparameter| is greater, >= 0.
  double relative_reduction = 1e-9;  ///< Stop when a step lowers the error by at most this share, >= 0; 0: never.
  double initial_damping = 1e-2;     ///< mu at the start, relative to the diagonal of J^T J, > 0.
  LevenbergMarquardtObserver observer = {};  ///< May be empty.
};

enum class LevenbergMarquardtStop : std::uint8_t {
  error_goal,
  gradient_limit,
  relative_reduction,
  no_descent,      ///< No step lowers the error, however short.
  max_iterations,  ///< This and the following: not converged.
  observer,        ///< It returned false.
  not_finite,      ///< The error of the start, or a derivative on the way.
};

struct LevenbergMarquardtReport {
  double initial_error = 0.0;
  double final_error = 0.0;
  int iterations = 0;
  LevenbergMarquardtStop stop = LevenbergMarquardtStop::max_iterations;

  [[nodiscard]] bool converged() const noexcept { return stop < LevenbergMarquardtStop::max_iterations; }
};

/// Minimises half the sum of `residual_count` squared residuals over `parameters`, in place. The best point seen is
/// kept. A point with a residual that is not finite is never accepted. Marquardt's scaling: (J^T J + mu diag(J^T J))
/// step = -J^T r. A good step divides mu by 10, a bad one multiplies it by 10. Levenberg 1944, Marquardt 1963.
/// Thread-safe.
LevenbergMarquardtReport minimise(const ResidualFunction& residual_function, std::size_t residual_count,
                                  std::vector<double>& parameters, const LevenbergMarquardtOptions& options = {});

/// The same for any problem of least squares.
LevenbergMarquardtReport minimise(LeastSquaresProblem& problem, std::vector<double>& parameters,
                                  const LevenbergMarquardtOptions& options = {});

/// A residual of a fit, and how strongly the fit follows its datum.
struct FittedResidual {
  double residual = 0.0;         ///< r
  double leverage = 0.0;         ///< h, 0 ... 0.95, from the linearised problem.
  double common_leverage = 0.0;  ///< H, h ... 0.95: on the estimate, of a shift that the datum's group has in common.
  double common = 0.0;           ///< m: mean residual of the group, of which a datum alone is one.

  /// The residual with its datum left out of the fit: r / (1 - h). Allen 1974 (PRESS).
  [[nodiscard]] double left_out() const noexcept { return residual / (1.0 - leverage); }

  /// r scaled to another variance. The shared part of a group has the variance s^2. m has (1 - H) s^2, as the fit
  /// follows it. as_noise() scales m to s^2, as_new_error() to (1 + H) s^2, the variance of the error on a new group in
  /// the same place. The fit hardly follows the differences between data of a group, so r - m stays.
  [[nodiscard]] double as_noise() const noexcept;
  [[nodiscard]] double as_new_error() const noexcept;
};

/// The first `data_count` residuals at the minimum `parameters` (all residuals, a penalty's rows included, shape the
/// normal matrix). data_count >= 1 and at least one parameter. `groups` [data_count]: data with the same number share
/// their error; empty: each has its own. Thread-safe.
[[nodiscard]] std::vector<FittedResidual> fitted_residuals(const ResidualFunction& residual_function,
                                                           std::size_t data_count, std::size_t residual_count,
                                                           std::span<const double> parameters,
                                                           std::span<const std::size_t> groups = {});

/// Mean square of the first `data_count` residuals, each with its own datum left out, without any refit. Conditions as
/// for fitted_residuals().
[[nodiscard]] double leave_one_out_mean_square(const ResidualFunction& residual_function, std::size_t data_count,
                                               std::size_t residual_count, std::span<const double> parameters);

}  // namespace dermis::touch::network
