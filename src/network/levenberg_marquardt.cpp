// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/network/levenberg_marquardt.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

namespace dermis::network {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

constexpr double kDampingFactor = 10.0;
constexpr double kMaxDamping = 1e12;
constexpr double kMinDamping = 1e-12;
constexpr double kMaxLeverage = 0.95;
constexpr double kDiagonalFloor = 1e-12;  // keeps parameters without influence from making the system singular

std::span<double> view(Vector& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}
std::span<const double> view(const Vector& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}

}  // namespace

LevenbergMarquardtReport minimise(const ResidualFunction& residual_function, std::size_t residual_count,
                                  std::vector<double>& parameters, const LevenbergMarquardtOptions& options) {
  const auto m = static_cast<Eigen::Index>(residual_count);
  const auto n = static_cast<Eigen::Index>(parameters.size());
  Vector point = Eigen::Map<const Vector>(parameters.data(), n);
  Vector residuals(m);
  Vector trial_residuals(m);
  Matrix jacobian(m, n);
  Matrix normal(n, n);
  Vector gradient(n);

  const auto linearise = [&] {
    residual_function(view(std::as_const(point)), view(residuals),
                      {jacobian.data(), static_cast<std::size_t>(jacobian.size())});
    normal.setZero();
    normal.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.transpose());
    gradient.noalias() = jacobian.transpose() * residuals;
  };

  LevenbergMarquardtReport report;
  linearise();
  double error = 0.5 * residuals.squaredNorm();
  report.initial_error = error;
  double damping = options.initial_damping;
  while (report.iterations < options.max_iterations && !report.converged) {
    ++report.iterations;
    Matrix damped = normal;
    const double floor = kDiagonalFloor * std::max(normal.diagonal().maxCoeff(), 1e-300);
    damped.diagonal() += damping * normal.diagonal().cwiseMax(floor);
    const Vector step = damped.selfadjointView<Eigen::Lower>().ldlt().solve(-gradient);
    const Vector trial = point + step;
    residual_function(view(trial), view(trial_residuals), {});
    const double trial_error = 0.5 * trial_residuals.squaredNorm();
    if (std::isfinite(trial_error) && trial_error < error) {
      report.converged = error - trial_error <= options.relative_reduction * error;
      point = trial;
      error = trial_error;
      damping = std::max(damping / kDampingFactor, kMinDamping);
      if (!report.converged) linearise();
    } else {
      damping *= kDampingFactor;
      if (damping > kMaxDamping) {  // no direction goes down any more
        report.converged = std::isfinite(error);
        break;
      }
    }
  }
  report.final_error = error;
  Eigen::Map<Vector>(parameters.data(), n) = point;
  return report;
}

double leave_one_out_mean_square(const ResidualFunction& residual_function, std::size_t data_count,
                                 std::size_t residual_count, std::span<const double> parameters) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  Vector residuals(static_cast<Eigen::Index>(residual_count));
  Matrix jacobian(residuals.size(), n);
  residual_function(parameters, view(residuals), {jacobian.data(), static_cast<std::size_t>(jacobian.size())});
  Matrix normal = jacobian.transpose() * jacobian;
  normal.diagonal().array() += kDiagonalFloor * std::max(normal.diagonal().maxCoeff(), 1e-300);
  const Eigen::LDLT<Matrix> factors(normal);
  double square = 0.0;
  for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(data_count); ++j) {
    const Vector row = jacobian.row(j);
    const double leverage = std::clamp(row.dot(factors.solve(row)), 0.0, kMaxLeverage);
    square += std::pow(residuals[j] / (1.0 - leverage), 2);
  }
  return square / static_cast<double>(data_count);
}

}  // namespace dermis::network
