// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/preprocessing/temperature_field.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace dermis::preprocessing {
namespace {

using Places = std::vector<TemperatureSensor>;

constexpr double kSensorNoiseCelsius = 0.2;
constexpr double kUsualGradientCelsius = 5.0;  // weighs several sensors, where the array tells none
constexpr double kSpotShare = 0.1;             // of the gradient
constexpr double kSpotWidth = 0.25;            // of the sheet

/// Temperatures at two places have this in common, beside the mean of the sheet [C^2].
class Covariance {
 public:
  Covariance(const ArrayDescription& array, double gradient_celsius)
      : middle_{0.5 * static_cast<double>(array.rows - 1), 0.5 * static_cast<double>(array.cols - 1)},
        sheet_(static_cast<double>(std::max(array.rows, array.cols))),
        gradient_(gradient_celsius) {}

  [[nodiscard]] double operator()(const TemperatureSensor& a, const TemperatureSensor& b) const {
    const double aligned =
        ((a.row - middle_.row) * (b.row - middle_.row) + (a.col - middle_.col) * (b.col - middle_.col)) /
        (sheet_ * sheet_);
    const double apart = std::hypot(a.row - b.row, a.col - b.col) / (kSpotWidth * sheet_);
    return gradient_ * gradient_ * (aligned + kSpotShare * kSpotShare * std::exp(-0.5 * apart * apart));
  }

 private:
  TemperatureSensor middle_;
  double sheet_;
  double gradient_;
};

Places sensors_of(const ArrayDescription& array) {
  if (!array.temperature_sensors.empty()) return array.temperature_sensors;
  return {{0.5 * static_cast<double>(array.rows - 1), 0.5 * static_cast<double>(array.cols - 1)}};
}

/// Each sensor with each, noise included.
Eigen::MatrixXd covariance_of(const Places& sensors, const Covariance& covariance) {
  const auto count = static_cast<Eigen::Index>(sensors.size());
  Eigen::MatrixXd all(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index k = 0; k < count; ++k) {
      all(i, k) = covariance(sensors[static_cast<std::size_t>(i)], sensors[static_cast<std::size_t>(k)]);
    }
    all(i, i) += kSensorNoiseCelsius * kSensorNoiseCelsius;
  }
  return all;
}

Eigen::VectorXd covariance_with(const TemperatureSensor& place, const Places& sensors, const Covariance& covariance) {
  Eigen::VectorXd with(static_cast<Eigen::Index>(sensors.size()));
  for (std::size_t k = 0; k < sensors.size(); ++k) with[static_cast<Eigen::Index>(k)] = covariance(place, sensors[k]);
  return with;
}

}  // namespace

TemperatureField::TemperatureField(const ArrayDescription& array) : taxels_(array.taxel_count()) {
  const Places sensors = sensors_of(array);
  const Places taxels = sensors_on_each_taxel(array.rows, array.cols);
  readings_.resize(sensors.size());
  if (sensors == taxels) return;
  const double told = array.temperature_gradient_celsius;
  const Covariance covariance(array, told > 0.0 ? told : kUsualGradientCelsius);
  const Eigen::LDLT<Eigen::MatrixXd> solver(covariance_of(sensors, covariance));
  const Eigen::VectorXd of_mean = solver.solve(Eigen::VectorXd::Ones(static_cast<Eigen::Index>(sensors.size())));
  double variance = 0.0;
  for (const TemperatureSensor& taxel : taxels) {
    const Eigen::VectorXd with = covariance_with(taxel, sensors, covariance);
    Eigen::VectorXd weights = solver.solve(with);
    const double of_others = 1.0 - weights.sum();
    variance += covariance(taxel, taxel) - with.dot(weights) + of_others * of_others / of_mean.sum();
    weights += of_others / of_mean.sum() * of_mean;
    for (const double weight : weights) weights_.push_back(static_cast<float>(weight));
  }
  if (told > 0.0) sigma_celsius_ = std::sqrt(variance / static_cast<double>(taxels.size()));
}

bool TemperatureField::interpolate(std::span<const float> sensors, std::vector<float>& taxels) noexcept {
  float sum = 0.0F;
  float known = 0.0F;
  for (const float celsius : sensors) {
    if (!std::isfinite(celsius)) continue;
    sum += celsius;
    known += 1.0F;
  }
  if (sensors.size() != readings_.size() || known == 0.0F) {
    taxels.clear();
    return false;
  }
  const float mean = sum / known;
  std::transform(sensors.begin(), sensors.end(), readings_.begin(),
                 [mean](float celsius) { return std::isfinite(celsius) ? celsius : mean; });
  if (weights_.empty()) {
    taxels.assign(readings_.begin(), readings_.end());
    return true;
  }
  taxels.resize(taxels_);
  const float* weights = weights_.data();
  for (float& celsius : taxels) {
    celsius = 0.0F;
    for (const float reading : readings_) celsius += *weights++ * reading;
  }
  return true;
}

}  // namespace dermis::preprocessing
