// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <span>
#include <string>

#include "engine.hpp"
#include "reference.hpp"

namespace dermis::benchmarks {

/// The network 2-H-1 on the Peaks samples with Eigen, samples contiguous: each value of a unit is a column over the
/// samples. Parameters as NetworkShape orders them: weights [H, 2], thresholds [H], output weights [H], its threshold.
template <typename Real>
class EigenPeaks {
 public:
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

  explicit EigenPeaks(const PeaksProblem& problem)
      : hidden_(static_cast<Eigen::Index>(problem.shape.layers[0].units)),
        inputs_(static_cast<Eigen::Index>(problem.count()), 2),
        targets_(inputs_.rows()) {
    for (Eigen::Index p = 0; p < inputs_.rows(); ++p) {
      const auto k = static_cast<std::size_t>(p);
      inputs_(p, 0) = static_cast<Real>(problem.inputs[2 * k]);
      inputs_(p, 1) = static_cast<Real>(problem.inputs[2 * k + 1]);
      targets_(p) = static_cast<Real>(problem.targets[k]);
    }
  }

  /// Half the sum of squared differences, output - target.
  Real error(std::span<const Real> parameters) {
    const View view(parameters, hidden_);
    // One statement each: together they are not vectorised.
    outputs_.noalias() = inputs_ * view.weights.transpose();
    outputs_.rowwise() += view.thresholds.transpose();
    outputs_ = outputs_.array().logistic();
    difference_.noalias() = outputs_ * view.output_weights;
    difference_.array() += view.output_threshold;
    difference_ -= targets_;
    return Real(0.5) * difference_.squaredNorm();
  }

  /// The same and its gradient.
  Real error_and_gradient(std::span<const Real> parameters, std::span<Real> gradient) {
    const Real result = error(parameters);
    const View view(parameters, hidden_);
    Eigen::Map<RowMatrix> weights(gradient.data(), hidden_, 2);
    Eigen::Map<Vector> thresholds(gradient.data() + 2 * hidden_, hidden_);
    Eigen::Map<Vector> output_weights(gradient.data() + 3 * hidden_, hidden_);
    output_weights.noalias() = outputs_.transpose() * difference_;
    gradient.back() = difference_.sum();
    for (Eigen::Index unit = 0; unit < hidden_; ++unit) {
      const auto output = outputs_.col(unit).array();
      delta_ = view.output_weights(unit) * difference_.array() * (output - output.square());
      weights.row(unit).noalias() = delta_.transpose() * inputs_;
      thresholds(unit) = delta_.sum();
    }
    return result;
  }

  /// The same and the Jacobian of the outputs in `jacobian` [samples, parameters].
  Real linearise(std::span<const Real> parameters, Matrix& jacobian, Vector& gradient) {
    const Real result = error(parameters);
    const View view(parameters, hidden_);
    jacobian.resize(inputs_.rows(), 4 * hidden_ + 1);
    for (Eigen::Index unit = 0; unit < hidden_; ++unit) {
      auto delta = jacobian.col(2 * hidden_ + unit);
      const auto output = outputs_.col(unit);
      delta = view.output_weights(unit) * (output.array() - output.array().square());
      jacobian.col(2 * unit) = delta.cwiseProduct(inputs_.col(0));
      jacobian.col(2 * unit + 1) = delta.cwiseProduct(inputs_.col(1));
      jacobian.col(3 * hidden_ + unit) = output;
    }
    jacobian.col(4 * hidden_).setOnes();
    gradient.noalias() = jacobian.transpose() * difference_;
    return result;
  }

 private:
  using RowMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  struct View {
    View(std::span<const Real> parameters, Eigen::Index hidden)
        : weights(parameters.data(), hidden, 2),
          thresholds(parameters.data() + 2 * hidden, hidden),
          output_weights(parameters.data() + 3 * hidden, hidden),
          output_threshold(parameters.back()) {}
    Eigen::Map<const RowMatrix> weights;
    Eigen::Map<const Vector> thresholds;
    Eigen::Map<const Vector> output_weights;
    Real output_threshold;
  };

  Eigen::Index hidden_;
  Matrix inputs_;
  Vector targets_;
  Matrix outputs_;  ///< Of the hidden units.
  Vector difference_;
  Vector delta_;
};

/// One Levenberg-Marquardt step from the start. rank_update(jacobian, normal) writes the lower triangle of J^T J.
template <typename RankUpdate>
Run eigen_step(const PeaksProblem& problem, RankUpdate rank_update, const std::string& note) {
  const auto result = std::make_shared<LevenbergMarquardtStep>();
  result->step.resize(problem.parameters.size());
  const auto n = static_cast<Eigen::Index>(result->step.size());
  const auto take = [=, network = EigenPeaks<double>(problem), parameters = reference::as_double(problem.parameters),
                     jacobian = Eigen::MatrixXd(), normal = Eigen::MatrixXd(n, n),
                     gradient = Eigen::VectorXd()]() mutable {
    network.linearise(parameters, jacobian, gradient);
    rank_update(jacobian, normal);
    normal.diagonal() *= 1.0 + kDamping;
    Eigen::Map<Eigen::VectorXd> step(result->step.data(), n);
    step = -normal.selfadjointView<Eigen::Lower>().ldlt().solve(gradient);
    std::vector<double> trial = parameters;
    Eigen::Map<Eigen::VectorXd>(trial.data(), n) += step;
    result->trial_error = network.error(trial);
  };
  std::function<void()> step = take;
  step();
  return {step, check_step(problem, *result), note};
}

}  // namespace dermis::benchmarks
