// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/shared_errors.hpp"

#include <cmath>

#include "compensation/readout_parts.hpp"
#include "compensation/sensed_line.hpp"
#include "dermis/core/axis.hpp"

namespace dermis::compensation {
namespace {

/// As GroundedRows or VirtualGround invert it, or nothing has to be inverted.
bool has_grounded_lines(const Readout& readout) {
  if (has_resistive_lines(readout)) return false;
  const bool is_virtual = readout.circuit == Circuit::transimpedance && has_ideal_amplifiers(readout);
  return readout.circuit == Circuit::none || readout.circuit == Circuit::flexitac || is_virtual ||
         readout.idle_rows == IdleRows::grounded;
}

}  // namespace

/// What variance() finds of a frame, by lines.
struct SharedErrors::Frame {
  std::vector<double> driven_sum;       // sum_j G_ij [driven]
  std::vector<double> driven_gain;      // a [driven]
  std::vector<double> own_gain;         // (S D^-1)_ii [driven]
  std::vector<double> driven_weighted;  // u [driven]
  std::vector<double> sensed_sum;       // sum_i G_ij [sensed]
  std::vector<double> sensed_gain;      // 1 / w [sensed]
  std::vector<double> sensed_shunt;     // eta [sensed]
  std::vector<double> sensed_weighted;  // sum_i c_ij G_ij [sensed]
  std::vector<double> sensed_taken;     // one loaded: sum_i (1 + G_ij Rd_i) y_ij / w_j [sensed]
};

SharedErrors::SharedErrors(const ArrayDescription& array)
    : driven_step_(driven_axis(array) == Axis::row ? array.cols : 1),
      sensed_step_(driven_axis(array) == Axis::row ? 1 : array.cols),
      tells_noise_(has_grounded_lines(array.readout)),
      one_loaded_(array.readout.idle_columns == IdleColumns::floating || array.readout.circuit == Circuit::flexitac),
      supply_noise_(array.readout.adc_reference_v ? array.readout.supply_noise : 0.0),
      driven_ohm_(array.driven_lines()),
      sensed_ohm_(array.sensed_lines()),
      reading_siemens_(array.sensed_lines(), 1.0),
      correlation_(array.readout.drive_error_correlation) {
  const Readout& readout = array.readout;
  if (readout.circuit == Circuit::none) return;
  driven_ohm_ = readout.drive_ohm;
  for (std::size_t line = 0; line < sensed_ohm_.size(); ++line) {
    const SensedLine sensed = sensed_line(readout, line);
    sensed_ohm_[line] = sensed.rho;
    reading_siemens_[line] = 1.0 / sensed.gain;
  }
  if (tells_noise_ && !is_absent(readout.drive_error_ohm)) drive_error_ohm_ = readout.drive_error_ohm;
}

double SharedErrors::variance(const ConductanceErrors& errors, std::span<const double> weight) const noexcept {
  thread_local Frame frame;
  find_lines(errors, weight, frame);
  return noise(errors, weight, frame) + supply(errors, weight, frame) + estimated_taxels(errors, frame) +
         drivers(errors, weight, frame);
}

void SharedErrors::find_lines(const ConductanceErrors& errors, std::span<const double> weight,
                              Frame& frame) const noexcept {
  frame.driven_sum.assign(driven_ohm_.size(), 0.0);
  frame.driven_gain.assign(driven_ohm_.size(), 1.0);
  frame.driven_weighted.assign(driven_ohm_.size(), 0.0);
  frame.sensed_sum.assign(sensed_ohm_.size(), 0.0);
  frame.sensed_weighted.assign(sensed_ohm_.size(), 0.0);
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
      const double siemens = errors.siemens[at(i, j)];
      const double weighted = weight[at(i, j)] * siemens;
      frame.driven_sum[i] += siemens;
      frame.driven_weighted[i] += driven_ohm_[i] * weighted;
      frame.sensed_sum[j] += siemens;
      frame.sensed_weighted[j] += weighted;
    }
    frame.driven_gain[i] += driven_ohm_[i] * frame.driven_sum[i];
  }
  find_columns(errors, frame);
}

/// With one load w depends on y, which is G w / a here.
void SharedErrors::find_columns(const ConductanceErrors& errors, Frame& frame) const noexcept {
  frame.sensed_gain.assign(sensed_ohm_.size(), 1.0);
  frame.sensed_shunt.assign(sensed_ohm_.size(), 0.0);
  frame.sensed_taken.assign(sensed_ohm_.size(), 0.0);
  frame.own_gain = frame.driven_gain;
  for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
    const double sum = frame.sensed_sum[j];
    frame.sensed_gain[j] += sensed_ohm_[j] * sum;
    frame.sensed_shunt[j] = sensed_ohm_[j] / frame.sensed_gain[j];
    if (!one_loaded_ || !(sum > 0.0)) continue;
    frame.sensed_shunt[j] = 1.0 / sum;
    for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
      const double siemens = errors.siemens[at(i, j)];
      const double dropped = driven_ohm_[i] * siemens * siemens / frame.driven_gain[i];
      frame.sensed_gain[j] += dropped / sum;
      frame.sensed_taken[j] += siemens / frame.driven_gain[i] + dropped;
    }
  }
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
      const double siemens = errors.siemens[at(i, j)];
      frame.own_gain[i] -= driven_ohm_[i] * siemens * siemens * frame.sensed_shunt[j];
    }
  }
}

double SharedErrors::noise(const ConductanceErrors& errors, std::span<const double> weight,
                           const Frame& frame) const noexcept {
  double variance = 0.0;
  for (std::size_t k = 0; k < errors.noise_siemens.size(); ++k) {
    variance += std::pow(weight[k] * static_cast<double>(errors.noise_siemens[k]), 2);
  }
  if (!tells_noise_) return variance;
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
      const double alone = errors.sigma_ratio * reading_siemens_[j] * frame.own_gain[i] * frame.sensed_gain[j];
      const double through_sensed = sensed_ohm_[j] * frame.sensed_weighted[j];
      const double shift = alone * (weight[at(i, j)] + frame.driven_weighted[i] + through_sensed);
      variance += shift * shift;
    }
  }
  return variance;
}

double SharedErrors::supply(const ConductanceErrors& errors, std::span<const double> weight,
                            const Frame& frame) const noexcept {
  const double sigma = std::hypot(supply_noise_, errors.supply_doubt);
  if (sigma == 0.0) return 0.0;
  double shift = 0.0;
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
      const double weighted = weight[at(i, j)] * static_cast<double>(errors.siemens[at(i, j)]);
      shift += weighted * frame.driven_gain[i] * frame.sensed_gain[j];
    }
  }
  return sigma * sigma * shift * shift;
}

double SharedErrors::estimated_taxels(const ConductanceErrors& errors, const Frame& frame) const noexcept {
  double variance = 0.0;
  for (std::size_t k = 0; k < errors.doubt_siemens.size(); ++k) {
    if (errors.doubt_siemens[k] == 0.0F) continue;
    const std::size_t i = k / driven_step_ % driven_ohm_.size();
    const std::size_t j = k / sensed_step_ % sensed_ohm_.size();
    const double shift = frame.driven_weighted[i] + sensed_ohm_[j] * frame.sensed_weighted[j];
    variance += std::pow(static_cast<double>(errors.doubt_siemens[k]) * shift, 2);
  }
  return variance;
}

double SharedErrors::drivers(const ConductanceErrors& errors, std::span<const double> weight,
                             const Frame& frame) const noexcept {
  double common = 0.0;
  double square = 0.0;
  for (std::size_t k = 0; k < drive_error_ohm_.size(); ++k) {
    const double shift = drive_error_ohm_[k] * driver_shift(k, errors, weight, frame);
    common += shift;
    square += shift * shift;
  }
  return correlation_ * common * common + (1.0 - correlation_) * square;
}

/// sum_i L_ik (sum_j c_ij p_kj + u_i sum_j p_kj) + sum_j (sum_i c_ij G_ij) c_kj - sum_j c_kj G_kj^2; DriverError names
/// the symbols.
double SharedErrors::driver_shift(std::size_t driver, const ConductanceErrors& errors, std::span<const double> weight,
                                  const Frame& frame) const noexcept {
  const double gain = frame.driven_gain[driver];
  double shift = 0.0;
  double sum_of_lifts = 0.0;
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    double lift = i == driver ? frame.driven_sum[driver] : 0.0;  // L_ik
    double weighted = frame.driven_weighted[i] * frame.driven_sum[driver] / gain;
    for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
      const double of_driver = errors.siemens[at(driver, j)];
      lift -= static_cast<double>(errors.siemens[at(i, j)]) * frame.sensed_shunt[j] * of_driver;
      weighted += weight[at(i, j)] * of_driver / gain;
    }
    sum_of_lifts += lift;
    shift += lift * weighted;
  }
  for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
    const double siemens = errors.siemens[at(driver, j)];
    shift -= weight[at(driver, j)] * siemens * siemens;
    const double taken = frame.sensed_taken[j];
    const double of_one_load = taken > 0.0 ? siemens * siemens / (gain * taken) : 0.0;
    const double share = one_loaded_ ? of_one_load : sensed_ohm_[j] * siemens / gain * sum_of_lifts;
    shift += frame.sensed_weighted[j] * share;
  }
  return shift;
}

}  // namespace dermis::compensation
