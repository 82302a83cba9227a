// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/taxel_training.hpp"

#include <algorithm>
#include <cmath>

#include "dermis/network/levenberg_marquardt.hpp"

namespace dermis::calibration {
namespace {

constexpr double kNoiseFloor = 0.003;  // relative; temperature and supply meters, repeatability
constexpr int kStarts = 6;
constexpr int kMaxIterations = 100;
constexpr double kRelativeReduction = 1e-5;

struct TrainingPoint {
  ForceNetwork::Inputs inputs;
  double log_newtons = 0.0;
  double weight = 0.0;  // 1 / standard deviation of ln(newtons)
};

double geometric_mean(std::span<const TaxelPoint> points, double TaxelPoint::*member) {
  double sum = 0.0;
  for (const TaxelPoint& point : points) sum += std::log(point.*member);
  return std::exp(sum / static_cast<double>(points.size()));
}

}  // namespace

ForceNetwork train_taxel(const network::PerceptronShape& shape, std::span<const TaxelPoint> points,
                         double noise_siemens, std::uint64_t seed) {
  ForceNetwork network;
  network.shape = shape;
  network.reference_siemens = geometric_mean(points, &TaxelPoint::excess_siemens);
  network.heaviest_siemens = 0.0;
  network.parameters.resize(shape.parameter_count());
  std::vector<TrainingPoint> training;
  for (const TaxelPoint& point : points) {
    network.heaviest_siemens = std::max(network.heaviest_siemens, point.excess_siemens);
    network.heaviest_newtons = std::max(network.heaviest_newtons, point.newtons);
    training.push_back({network.inputs(point.excess_siemens, point.temperature), std::log(point.newtons),
                        1.0 / std::hypot(kNoiseFloor, noise_siemens / point.excess_siemens)});
  }

  const std::size_t n = shape.parameter_count();
  const network::ResidualFunction residual_function = [&](std::span<const double> free, std::span<double> residuals,
                                                          std::span<double> jacobian) {
    network::monotone::parameters(shape, free, network.parameters);
    for (std::size_t k = 0; k < training.size(); ++k) {
      const TrainingPoint& point = training[k];
      const std::span<double> row = jacobian.empty() ? jacobian : jacobian.subspan(k * n, n);
      residuals[k] = point.weight * (network.log_newtons(point.inputs, row) - point.log_newtons);
      for (double& derivative : row) derivative *= point.weight;
    }
    prior_residuals(network, 1.0, residuals.subspan(training.size()),
                    jacobian.empty() ? jacobian : jacobian.subspan(training.size() * n), n);
  };

  Random random(seed);
  std::vector<double> best;
  double best_error = 0.0;
  for (int start = 0; start < kStarts; ++start) {
    std::vector<double> free = random_start(shape, geometric_mean(points, &TaxelPoint::newtons), random);
    network::LevenbergMarquardtOptions options;
    options.max_iterations = kMaxIterations;
    options.relative_reduction = kRelativeReduction;
    const auto report = network::minimise(residual_function, training.size() + n, free, options);
    if (!best.empty() && report.final_error >= best_error) continue;
    best = std::move(free);
    best_error = report.final_error;
  }
  const auto fitted = network::fitted_residuals(residual_function, training.size(), training.size() + n, best);
  for (std::size_t k = 0; k < training.size(); ++k) {
    network.noise.push_back(fitted[k].as_noise() / training[k].weight);
    network.new_errors.push_back(fitted[k].as_new_error() / training[k].weight);
  }
  network::monotone::parameters(shape, best, network.parameters);

  double square = 0.0;
  for (const TrainingPoint& point : training) {
    square += std::pow(std::expm1(network.log_newtons(point.inputs, {}) - point.log_newtons), 2);
  }
  network.rms_error = std::sqrt(square / static_cast<double>(training.size()));
  return network;
}

}  // namespace dermis::calibration
