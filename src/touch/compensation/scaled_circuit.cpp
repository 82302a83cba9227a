// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/scaled_circuit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "touch/compensation/sensed_line.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kLeastOpenShare = 1e-9;  // of the supply that a reading leaves to its taxel; less is no solution

}  // namespace

double ReadingScale::apparent_siemens(double ratio) const noexcept {
  const double current = (ratio - offset) / gain;
  return current / std::max(1.0 - series * current, kLeastOpenShare);
}

double ReadingScale::scaled(double ratio) const noexcept {
  return scaled_siemens(apparent_siemens(ratio));
}

double ReadingScale::scaled_siemens(double siemens) const noexcept {
  return std::asinh(siemens / (2.0 * scale));
}

double ReadingScale::slope(double ratio) const noexcept {
  return 1.0 / (open_slope(ratio) * std::hypot(apparent_siemens(ratio), 2.0 * scale));
}

double ReadingScale::open_slope(double ratio) const noexcept {
  const double open = std::max(1.0 - series * (ratio - offset) / gain, kLeastOpenShare);
  return gain * open * open;
}

double ReadingScale::siemens(double x) const noexcept {
  return std::min(2.0 * scale * std::sinh(x), kMostSiemens);
}

double ReadingScale::siemens_slope(double x) const noexcept {
  return 2.0 * scale * std::cosh(x);
}

ScaledCircuit::ScaledCircuit(const ArrayDescription& array, CircuitModel model, const ReferenceConductances& references)
    : model_(std::move(model)), film_(array, references) {
  const Readout& readout = array.readout;
  const double noise_ratio = readout.adc_noise_counts / readout.full_scale_counts();
  const bool columns_are_driven = readout.circuit == Circuit::flexitac;
  for (std::size_t row = 0; row < array.rows; ++row) {
    for (std::size_t col = 0; col < array.cols; ++col) {
      const SensedLine sensed = sensed_line(readout, columns_are_driven ? row : col);
      const std::size_t driver = columns_are_driven ? col : row;
      const double series = readout.drive_ohm[driver] + sensed.rho;
      readings_.push_back({sensed.gain, sensed.offset, series, noise_ratio / sensed.gain, driver});
    }
  }
  for (auto* values : {&measured_, &x_, &siemens_, &misfit_}) values->resize(array.taxel_count());
}

void ScaledCircuit::hold_film(const FilmConductances& film) noexcept {
  film_.hold(film);
  model_.set_film(film_.film());
}

void ScaledCircuit::set_frame(std::span<const double> ratio, std::span<const double> siemens) noexcept {
  ratio_ = ratio;
  for (std::size_t k = 0; k < ratio.size(); ++k) {
    if (is_kept(k)) {
      readings_[k].scale = readings_[k].noise;
      measured_[k] = readings_[k].scaled_siemens(siemens[k]);
      continue;
    }
    readings_[k].scale = std::max(readings_[k].noise, -readings_[k].apparent_siemens(ratio[k]));
    measured_[k] = readings_[k].scaled(ratio[k]);
  }
}

void ScaledCircuit::solve() noexcept {
  for (std::size_t k = 0; k < x_.size(); ++k) siemens_[k] = readings_[k].siemens(x_[k]);
  if (film_.follow(siemens_)) model_.set_film(film_.film());
  model_.solve(siemens_);
  for (std::size_t k = 0; k < x_.size(); ++k) {
    misfit_[k] = measured_[k] - (is_kept(k) ? x_[k] : readings_[k].scaled(model_.ratio()[k]));
  }
}

double ScaledCircuit::merit() const noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < x_.size(); ++k) {
    const double wrong = std::max(misfit_[k], -x_[k]);
    sum += wrong * wrong;
  }
  return std::sqrt(sum);
}

double ScaledCircuit::residual_ratio() const noexcept {
  double largest = 0.0;
  for (std::size_t k = 0; k < x_.size(); ++k) {
    if (is_kept(k)) continue;
    const double difference = ratio_[k] - model_.ratio()[k];
    largest = std::max(largest, x_[k] > 0.0 ? std::abs(difference) : difference);
  }
  return largest;
}

double ScaledCircuit::largest_ratio() const noexcept {
  double largest = 0.0;
  for (const double value : ratio_) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace dermis::touch::compensation
