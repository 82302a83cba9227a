// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/temperature_field.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace dermis::touch::preprocessing {
namespace {

using Places = std::vector<TemperatureSensor>;

constexpr double kSensorNoiseCelsius = 0.2;
constexpr double kUsualGradientCelsius = 5.0;  // weighs several sensors, where the array tells none
constexpr double kSpotShare = 0.1;             // of the gradient
constexpr double kSpotWidth = 0.25;            // of the sheet
constexpr float kMostCelsius = 1000.0F;        // above or below zero
constexpr int kMostSweeps = 200;
constexpr float kLeastChangeCelsius = 1e-4F;

/// Temperatures at two places have this in common, beside the mean of the sheet [C^2].
class Covariance {
 public:
  Covariance(const ArrayDescription& array, double gradient_celsius)
      : row_end_(static_cast<double>(array.rows - 1)),
        col_end_(static_cast<double>(array.cols - 1)),
        row_pitch_m_(array.row_pitch_m),
        col_pitch_m_(array.col_pitch_m),
        gradient_(gradient_celsius) {}

  [[nodiscard]] double operator()(const TemperatureSensor& a, const TemperatureSensor& b) const {
    const double aligned =
        along(a.row, row_end_) * along(b.row, row_end_) + along(a.col, col_end_) * along(b.col, col_end_);
    const double sheet_m = std::max({row_end_ * row_pitch_m_, col_end_ * col_pitch_m_, row_pitch_m_});
    const double apart =
        std::hypot((a.row - b.row) * row_pitch_m_, (a.col - b.col) * col_pitch_m_) / (kSpotWidth * sheet_m);
    return gradient_ * gradient_ * (aligned + kSpotShare * kSpotShare * std::exp(-0.5 * apart * apart));
  }

 private:
  /// From -1/2 at the first line to 1/2 at the last; 0 where there is one line.
  static double along(double place, double end) { return end > 0.0 ? place / end - 0.5 : 0.0; }

  double row_end_;
  double col_end_;
  double row_pitch_m_;
  double col_pitch_m_;
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

bool is_temperature(float celsius) {
  return std::abs(celsius) <= kMostCelsius;  // nor is NaN
}

/// The mean of those that are temperatures; NaN without any.
float mean_of(std::span<const float> sensors) {
  float sum = 0.0F;
  float known = 0.0F;
  for (const float celsius : sensors) {
    if (!is_temperature(celsius)) continue;
    sum += celsius;
    known += 1.0F;
  }
  return sum / known;
}

}  // namespace

TemperatureField::TemperatureField(const ArrayDescription& array) : shape_{array.rows, array.cols} {
  const Places sensors = sensors_of(array);
  readings_.resize(sensors.size());
  if (sensors != sensors_on_each_taxel(array.rows, array.cols)) weigh(array, sensors);
}

void TemperatureField::weigh(const ArrayDescription& array, const Places& sensors) {
  const Places taxels = sensors_on_each_taxel(array.rows, array.cols);
  const double told = array.temperature_gradient_celsius;
  const Covariance covariance(array, told > 0.0 ? told : kUsualGradientCelsius);
  const Eigen::MatrixXd of_sensors = covariance_of(sensors, covariance);
  const Eigen::LDLT<Eigen::MatrixXd> solver(of_sensors);
  const Eigen::VectorXd of_mean = solver.solve(Eigen::VectorXd::Ones(of_sensors.rows()));
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
  const Eigen::MatrixXd inverse = solver.solve(Eigen::MatrixXd::Identity(of_sensors.rows(), of_sensors.cols()));
  const Eigen::MatrixXd precision = inverse - of_mean * of_mean.transpose() / of_mean.sum();
  for (const double value : precision.reshaped()) precision_.push_back(static_cast<float>(value));
}

bool TemperatureField::interpolate(std::span<const float> sensors, std::vector<float>& taxels) noexcept {
  taxels.clear();
  const float mean = mean_of(sensors);
  if (sensors.size() != readings_.size() || std::isnan(mean)) return false;
  std::transform(sensors.begin(), sensors.end(), readings_.begin(),
                 [mean](float celsius) { return is_temperature(celsius) ? celsius : mean; });
  const bool all_read = std::all_of(sensors.begin(), sensors.end(), is_temperature);
  if (weights_.empty()) {
    if (!all_read) fill_in_map(sensors);
    taxels.assign(readings_.begin(), readings_.end());
    return true;
  }
  if (!all_read) fill_in(sensors);
  taxels.resize(shape_.taxel_count());
  const float* weights = weights_.data();
  for (float& celsius : taxels) {
    celsius = 0.0F;
    for (const float reading : readings_) celsius += *weights++ * reading;
  }
  return true;
}

/// Gives sensors that do not read what the others expect of them, by the method of Gauss and Seidel. The field is then
/// that of the others alone.
void TemperatureField::fill_in(std::span<const float> sensors) noexcept {
  const std::size_t count = readings_.size();
  float change = kLeastChangeCelsius;
  for (int sweep = 0; sweep < kMostSweeps && change >= kLeastChangeCelsius; ++sweep) {
    change = 0.0F;
    for (std::size_t k = 0; k < count; ++k) {
      if (is_temperature(sensors[k])) continue;
      const float* const row = precision_.data() + k * count;
      float sum = 0.0F;
      for (std::size_t j = 0; j < count; ++j) sum += row[j] * readings_[j];
      const float step = -sum / row[k];
      readings_[k] += step;
      change = std::max(change, std::abs(step));
    }
  }
}

void TemperatureField::fill_in_map(std::span<const float> sensors) noexcept {
  const std::size_t cols = shape_.cols;
  for (std::size_t taxel = 0; taxel < sensors.size(); ++taxel) {
    if (is_temperature(sensors[taxel])) continue;
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const std::size_t col = taxel % cols;
    const std::array<float, 4> neighbours{
        col > 0 ? sensors[taxel - 1] : kNone, col + 1 < cols ? sensors[taxel + 1] : kNone,
        taxel >= cols ? sensors[taxel - cols] : kNone, taxel + cols < sensors.size() ? sensors[taxel + cols] : kNone};
    if (const float mean = mean_of(neighbours); !std::isnan(mean)) readings_[taxel] = mean;
  }
}

}  // namespace dermis::touch::preprocessing
