// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/training/taxel_training.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dermis/touch/network/levenberg_marquardt.hpp"
#include "learn/calibration/training/force_levels.hpp"
#include "learn/calibration/training/force_problem.hpp"
#include "learn/calibration/training/temperature_levels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kNoiseFloor = 0.003;  // relative; temperature and supply meters, repeatability
constexpr int kStarts = 6;
constexpr int kMaxIterations = 100;
constexpr double kRelativeReduction = 1e-5;

double geometric_mean(std::span<const TaxelPoint> points, double TaxelPoint::*member) {
  double sum = 0.0;
  for (const TaxelPoint& point : points) sum += std::log(point.*member);
  return std::exp(sum / static_cast<double>(points.size()));
}

/// 1 / standard deviation of ln(newtons).
double weight_of(const TaxelPoint& point) {
  return 1.0 / std::hypot(kNoiseFloor, point.noise_siemens / point.excess_siemens);
}

NetworkPrior prior_of(const touch::network::PerceptronShape& shape, std::span<const TaxelPoint> points,
                      const TemperatureSpan& temperature) {
  NetworkPrior prior;
  if (count_levels(rising_loads(points)) < kLeastLevelsOfBend) prior.power = PowerPrior::straight;
  if (shape.inputs < touch::fusion::kInputsWithTemperature) return prior;
  std::vector<WarmLoad> warm;
  for (const TaxelPoint& point : points) warm.push_back({point.load_newtons, point.temperature});
  prior.temperature = temperature_prior(std::move(warm), temperature);
  prior.half_span_celsius = temperature.half_span_celsius;
  return prior;
}

/// The points of a taxel as samples of its network.
touch::network::PerceptronSamples samples_of(const ForceNetwork& network, std::span<const TaxelPoint> points) {
  const std::vector<std::size_t> terms(points.size(), 1);
  touch::network::PerceptronSamples samples(network.shape.inputs, touch::network::Estimate::output, terms);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ForceNetwork::Inputs inputs = network.inputs(points[k].excess_siemens, points[k].temperature);
    samples.set_input(k, 0, std::span(inputs).first(network.shape.inputs));
    samples.set_target(k, std::log(points[k].newtons), weight_of(points[k]));
  }
  return samples;
}

/// A network without parameters yet, with the range of the points.
ForceNetwork untrained(const touch::network::PerceptronShape& shape, std::span<const TaxelPoint> points) {
  ForceNetwork network;
  network.shape = shape;
  network.reference_siemens = geometric_mean(points, &TaxelPoint::excess_siemens);
  network.heaviest_siemens = 0.0;
  network.parameters.resize(shape.parameter_count());
  for (const TaxelPoint& point : points) {
    network.heaviest_siemens = std::max(network.heaviest_siemens, point.excess_siemens);
    network.heaviest_newtons = std::max(network.heaviest_newtons, point.newtons);
  }
  return network;
}

/// The points of a taxel as a problem of least squares.
class TaxelProblem {
 public:
  TaxelProblem(const touch::network::PerceptronShape& shape, std::span<const TaxelPoint> points,
               const TemperatureSpan& temperature)
      : points_(points),
        network_(untrained(shape, points)),
        samples_(samples_of(network_, points)),
        problem_(shape, samples_, prior_of(shape, points, temperature), 1.0) {}

  [[nodiscard]] double typical_newtons() const { return geometric_mean(points_, &TaxelPoint::newtons); }

  /// From the free parameters `start`, which become the best ones. Gives half the sum of squares.
  double minimise(std::vector<double>& start) {
    touch::network::LevenbergMarquardtOptions options;
    options.max_iterations = kMaxIterations;
    options.relative_reduction = kRelativeReduction;
    return touch::network::minimise(problem_, start, options).final_error;
  }

  /// Half the sum of squares.
  [[nodiscard]] double error(std::span<const double> free) { return problem_.error(free); }

  [[nodiscard]] ForceNetwork network_at(std::span<const double> free) {
    ForceNetwork network = network_;
    touch::network::monotone::parameters(network.shape, free, network.parameters);
    std::vector<std::size_t> touches;
    for (const TaxelPoint& point : points_) touches.push_back(point.touch);
    network.fitted = problem_.fitted(free, touches);
    double square = 0.0;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const double weight = weight_of(points_[k]);
      network.fitted[k].residual /= weight;
      network.fitted[k].common /= weight;
      square += std::pow(std::expm1(network.fitted[k].residual), 2);
    }
    network.rms_error = std::sqrt(square / static_cast<double>(points_.size()));
    return network;
  }

 private:
  std::span<const TaxelPoint> points_;
  ForceNetwork network_;
  touch::network::PerceptronSamples samples_;
  ForceProblem problem_;
};

/// The free values of a network's parameters.
std::vector<double> free_parameters(const ForceNetwork& network) {
  constexpr double kLeast = 1e-12;
  std::vector<double> free = network.parameters;
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (touch::network::monotone::is_positive(network.shape, k)) free[k] = std::log(std::max(free[k], kLeast));
  }
  return free;
}

}  // namespace

std::vector<double> rising_loads(std::span<const TaxelPoint> points) {
  std::vector<double> newtons;
  for (const TaxelPoint& point : points) newtons.push_back(point.load_newtons);
  std::sort(newtons.begin(), newtons.end());
  return newtons;
}

ForceNetwork train_taxel(const touch::network::PerceptronShape& shape, std::span<const TaxelPoint> points,
                         const TemperatureSpan& temperature, std::uint64_t seed) {
  TaxelProblem problem(shape, points, temperature);
  Random random(seed);
  std::vector<double> best;
  double best_error = 0.0;
  for (int start = 0; start < kStarts; ++start) {
    std::vector<double> free = random_start(shape, problem.typical_newtons(), random);
    const double error = problem.minimise(free);
    if (!best.empty() && error >= best_error) continue;
    best = std::move(free);
    best_error = error;
  }
  return problem.network_at(best);
}

std::optional<ForceNetwork> train_taxel_like(std::span<const ForceNetwork> others,
                                             const touch::network::PerceptronShape& shape,
                                             std::span<const TaxelPoint> points, const TemperatureSpan& temperature) {
  TaxelProblem problem(shape, points, temperature);
  std::vector<double> best;
  double best_error = 0.0;
  for (const ForceNetwork& other : others) {
    if (other.shape != shape) continue;
    std::vector<double> free = free_parameters(other);
    const double error = problem.error(free);
    if (!best.empty() && error >= best_error) continue;
    best = std::move(free);
    best_error = error;
  }
  if (best.empty()) return std::nullopt;
  problem.minimise(best);
  return problem.network_at(best);
}

}  // namespace dermis::learn::calibration
