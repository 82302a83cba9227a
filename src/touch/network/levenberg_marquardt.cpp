// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/network/levenberg_marquardt.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace dermis::touch::network {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

constexpr double kDampingFactor = 10.0;
constexpr double kMaxDamping = 1e12;
constexpr double kMinDamping = 1e-12;
constexpr double kMaxLeverage = 0.95;
constexpr double kDiagonalFloor = 1e-12;  // keeps parameters without influence from making the system singular

template <typename Dense>
std::span<double> view(Dense& dense) {
  return {dense.data(), static_cast<std::size_t>(dense.size())};
}
template <typename Dense>
std::span<const double> view(const Dense& dense) {
  return {dense.data(), static_cast<std::size_t>(dense.size())};
}

/// Half the sum of squared residuals.
class ResidualProblem : public LeastSquaresProblem {
 public:
  ResidualProblem(const ResidualFunction& residual_function, std::size_t residual_count, std::size_t parameter_count)
      : residual_function_(residual_function),
        residuals_(static_cast<Eigen::Index>(residual_count)),
        jacobian_(residuals_.size(), static_cast<Eigen::Index>(parameter_count)) {}

  double error(std::span<const double> point) override {
    residual_function_(point, view(residuals_), {});
    return 0.5 * residuals_.squaredNorm();
  }

  void linearise(std::span<const double> point, std::span<double> gradient, std::span<double> normal) override {
    residual_function_(point, view(residuals_), view(jacobian_));
    Eigen::Map<Matrix> square(normal.data(), jacobian_.cols(), jacobian_.cols());
    square.setZero();
    square.selfadjointView<Eigen::Lower>().rankUpdate(jacobian_.transpose());
    Eigen::Map<Vector>(gradient.data(), jacobian_.cols()).noalias() = jacobian_.transpose() * residuals_;
  }

 private:
  const ResidualFunction& residual_function_;
  Vector residuals_;
  Matrix jacobian_;
};

/// The damping loop.
class DampedDescent {
 public:
  DampedDescent(LeastSquaresProblem& problem, std::vector<double>& parameters, const LevenbergMarquardtOptions& options)
      : problem_(problem),
        parameters_(parameters.data(), static_cast<Eigen::Index>(parameters.size())),
        options_(options),
        point_(parameters_),
        gradient_(point_.size()),
        normal_(point_.size(), point_.size()),
        damping_(options.initial_damping) {}

  LevenbergMarquardtReport run() {
    LevenbergMarquardtReport report;
    linearise();
    error_ = problem_.error(view(point_));
    report.initial_error = error_;
    std::optional<Stop> stop = stop_at_start();
    while (!stop && report.iterations < options_.max_iterations) {
      ++report.iterations;
      stop = iterate();
      if (options_.observer && !options_.observer(report.iterations, error_, damping_) && !stop) stop = Stop::observer;
    }
    report.stop = stop.value_or(Stop::max_iterations);
    report.final_error = error_;
    return report;
  }

 private:
  using Stop = LevenbergMarquardtStop;

  [[nodiscard]] std::optional<Stop> stop_at_start() const {
    if (!std::isfinite(error_)) return Stop::not_finite;
    if (error_ <= options_.error_goal) return Stop::error_goal;
    return stop_at_gradient();
  }

  [[nodiscard]] std::optional<Stop> stop_at_gradient() const {
    if (!gradient_.allFinite() || !normal_.diagonal().allFinite()) return Stop::not_finite;
    if (gradient_.lpNorm<Eigen::Infinity>() <= options_.gradient_limit) return Stop::gradient_limit;
    return std::nullopt;
  }

  std::optional<Stop> iterate() {
    set_trial();
    const double trial_error = problem_.error(view(trial_));
    const double reduction = error_ - trial_error;
    if (!(reduction > 0.0)) {
      damping_ *= kDampingFactor;
      return damping_ > kMaxDamping ? std::optional(Stop::no_descent) : std::nullopt;
    }
    const bool slow = reduction <= options_.relative_reduction * error_;
    point_.swap(trial_);
    parameters_ = point_;
    error_ = trial_error;
    damping_ = std::max(damping_ / kDampingFactor, kMinDamping);
    if (error_ <= options_.error_goal) return Stop::error_goal;
    if (slow) return Stop::relative_reduction;
    linearise();
    return stop_at_gradient();
  }

  void linearise() { problem_.linearise(view(point_), view(gradient_), view(normal_)); }

  void set_trial() {
    damped_ = normal_;
    const double floor = kDiagonalFloor * std::max(normal_.diagonal().maxCoeff(), 1e-300);
    damped_.diagonal() += damping_ * normal_.diagonal().cwiseMax(floor);
    factors_.compute(damped_);
    trial_ = point_ - factors_.solve(gradient_);
  }

  LeastSquaresProblem& problem_;
  Eigen::Map<Vector> parameters_;
  const LevenbergMarquardtOptions& options_;
  Vector point_;
  Vector trial_;
  Vector gradient_;
  Matrix normal_;
  Matrix damped_;
  Eigen::LDLT<Matrix> factors_;
  double error_ = 0.0;
  double damping_;
};

/// Data that share an error.
struct ResidualGroup {
  Vector shift;  // the sum of their rows, then what a shift of them all does to the parameters
  double sum = 0.0;
  double size = 0.0;

  void add(const Vector& row, double residual) {
    shift += row;
    sum += residual;
    size += 1.0;
  }
};

}  // namespace

LevenbergMarquardtReport minimise(const ResidualFunction& residual_function, std::size_t residual_count,
                                  std::vector<double>& parameters, const LevenbergMarquardtOptions& options) {
  ResidualProblem problem(residual_function, residual_count, parameters.size());
  return minimise(problem, parameters, options);
}

LevenbergMarquardtReport minimise(LeastSquaresProblem& problem, std::vector<double>& parameters,
                                  const LevenbergMarquardtOptions& options) {
  return DampedDescent(problem, parameters, options).run();
}

double FittedResidual::as_noise() const noexcept {
  return std::copysign(std::hypot(common / std::sqrt(1.0 - common_leverage), residual - common), residual);
}

double FittedResidual::as_new_error() const noexcept {
  const double growth = std::sqrt((1.0 + common_leverage) / (1.0 - common_leverage));
  return std::copysign(std::hypot(common * growth, residual - common), residual);
}

std::vector<FittedResidual> fitted_residuals(const ResidualFunction& residual_function, std::size_t data_count,
                                             std::size_t residual_count, std::span<const double> parameters,
                                             std::span<const std::size_t> groups) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  Vector residuals(static_cast<Eigen::Index>(residual_count));
  Matrix jacobian(residuals.size(), n);
  residual_function(parameters, view(residuals), {jacobian.data(), static_cast<std::size_t>(jacobian.size())});
  Matrix normal = jacobian.transpose() * jacobian;
  normal.diagonal().array() += kDiagonalFloor * std::max(normal.diagonal().maxCoeff(), 1e-300);
  const Eigen::LDLT<Matrix> factors(normal);
  std::map<std::size_t, ResidualGroup> common;
  for (std::size_t j = 0; j < groups.size(); ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    common.try_emplace(groups[j], ResidualGroup{Vector::Zero(n)}).first->second.add(jacobian.row(row), residuals[row]);
  }
  for (auto& [number, group] : common) group.shift = factors.solve(group.shift).eval();
  std::vector<FittedResidual> fitted;
  for (std::size_t j = 0; j < data_count; ++j) {
    const Vector row = jacobian.row(static_cast<Eigen::Index>(j));
    const double leverage = std::clamp(row.dot(factors.solve(row)), 0.0, kMaxLeverage);
    const double residual = residuals[static_cast<Eigen::Index>(j)];
    FittedResidual& added = fitted.emplace_back(FittedResidual{residual, leverage, leverage, residual});
    if (groups.empty()) continue;
    const ResidualGroup& group = common.at(groups[j]);
    added.common_leverage = std::clamp(row.dot(group.shift), leverage, kMaxLeverage);
    added.common = group.sum / group.size;
  }
  return fitted;
}

double leave_one_out_mean_square(const ResidualFunction& residual_function, std::size_t data_count,
                                 std::size_t residual_count, std::span<const double> parameters) {
  double square = 0.0;
  for (const FittedResidual& datum : fitted_residuals(residual_function, data_count, residual_count, parameters)) {
    square += std::pow(datum.left_out(), 2);
  }
  return square / static_cast<double>(data_count);
}

}  // namespace dermis::touch::network
