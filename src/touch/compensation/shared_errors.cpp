// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/shared_errors.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/compensation/readout_parts.hpp"
#include "touch/compensation/sensed_line.hpp"

namespace dermis::touch::compensation {
namespace {

/// As GroundedRows or VirtualGround invert it, or nothing has to be inverted.
bool has_grounded_lines(const Readout& readout) {
  if (has_resistive_lines(readout)) return false;
  const bool is_virtual = readout.circuit == Circuit::transimpedance && has_ideal_amplifiers(readout);
  return readout.circuit == Circuit::none || readout.circuit == Circuit::flexitac || is_virtual ||
         readout.idle_rows == IdleRows::grounded;
}

double square(double value) {
  return value * value;
}

bool is_shared(const ConductanceErrors& errors) {
  return !errors.shared_noise.empty() && errors.shared_noise.front() > 0.0F;
}

/// sum_k C_|line-k| of_lines_k
double with_other_lines(std::span<const float> shared, std::span<const double> of_lines, std::size_t line) {
  double sum = 0.0;
  for (std::size_t other = 0; other < of_lines.size(); ++other) {
    const std::size_t distance = line > other ? line - other : other - line;
    sum += static_cast<double>(shared[distance]) * of_lines[other];
  }
  return sum;
}

DERMIS_PROCESSOR_CLONES bool any_other_than_zero(std::span<const float> values) {
  const float* const value = values.data();
  std::uint32_t any = 0;
  for (std::size_t k = 0; k < values.size(); ++k) any |= value[k] != 0.0F ? 1 : 0;
  return any != 0;
}

}  // namespace

/// The data that all sums of a frame share.
struct SharedErrors::Frame {
  std::vector<double> siemens;        // G_ij [driven, sensed]
  std::vector<double> driven_sum;     // sum_j G_ij [driven]
  std::vector<double> driven_gain;    // a [driven]
  std::vector<double> own_gain;       // (S D^-1)_ii [driven]
  std::vector<double> sensed_sum;     // sum_i G_ij [sensed]
  std::vector<double> sensed_gain;    // 1 / w [sensed]
  std::vector<double> sensed_shunt;   // eta [sensed]
  std::vector<double> sensed_taken;   // one loaded: sum_i (1 + G_ij Rd_i) y_ij / w_j [sensed]
  std::vector<std::size_t> doubted;   // taxels that are estimated
  double own_gains = 0.0;             // sum_i (S D^-1)_ii^2
  double sum_of_reading_gains = 0.0;  // sum_j q_j / sigma
  double reading_gains = 0.0;         // sum_j 1 / (gain_j w_j)^2

  [[nodiscard]] std::span<const double> of_driven(std::size_t i) const {
    const std::size_t sensed = sensed_sum.size();
    return std::span(siemens).subspan(i * sensed, sensed);
  }
};

/// A sum by lines.
struct SharedErrors::Sum {
  WeightedConductances of;
  std::vector<double> driven_weighted;  // u [driven]
  std::vector<double> sensed_weighted;  // sum_i c_ij G_ij [sensed]
  std::vector<bool> is_driven;          // a taxel of the sum is on the line [driven]
  std::vector<double> lift;             // L_ik of a driver k [driven]
  std::vector<double> line_shift;       // g [driven]
};

SharedErrors::SharedErrors(const ArrayDescription& array)
    : lines_(array.taxel_count()),
      driven_step_(driven_axis(array) == Axis::row ? array.cols : 1),
      sensed_step_(driven_axis(array) == Axis::row ? 1 : array.cols),
      tells_noise_(has_grounded_lines(array.readout)),
      one_loaded_(array.readout.idle_columns == IdleColumns::floating || array.readout.circuit == Circuit::flexitac),
      supply_noise_(array.readout.adc_reference_v ? array.readout.supply_noise : 0.0),
      driven_ohm_(array.driven_lines()),
      sensed_ohm_(array.sensed_lines()),
      reading_siemens_(array.sensed_lines(), 1.0),
      correlation_(array.readout.drive_error_correlation) {
  for (std::size_t driven = 0; driven < driven_ohm_.size(); ++driven) {
    for (std::size_t sensed = 0; sensed < sensed_ohm_.size(); ++sensed) lines_[at(driven, sensed)] = {driven, sensed};
  }
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

void SharedErrors::variances(const ConductanceErrors& errors, std::span<const WeightedConductances> sums,
                             std::span<double> variances) const noexcept {
  assert(sums.size() == variances.size());
  thread_local Frame frame;
  thread_local Sum sum;
  find_lines(errors, frame);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    weigh(frame, sums[k], sum);
    const double own = is_shared(errors) ? 1.0 - static_cast<double>(errors.shared_noise.front()) : 1.0;
    const double shared = is_shared(errors) ? shared_noise(errors, frame, sum) : 0.0;
    variances[k] = own * noise(errors, frame, sum) + shared + supply(errors, frame, sum) +
                   estimated_taxels(errors, frame, sum) + drivers(frame, sum);
  }
}

void SharedErrors::find_lines(const ConductanceErrors& errors, Frame& frame) const noexcept {
  frame.siemens.resize(errors.siemens.size());
  frame.driven_sum.resize(driven_ohm_.size());
  frame.driven_gain.resize(driven_ohm_.size());
  frame.sensed_sum.assign(sensed_ohm_.size(), 0.0);
  sum_conductances(errors.siemens, frame);
  find_sensed_lines(frame);
  find_own_gains(frame);
  frame.doubted.clear();
  if (!any_other_than_zero(errors.doubt_siemens)) return;
  for (std::size_t k = 0; k < errors.doubt_siemens.size(); ++k) {
    if (errors.doubt_siemens[k] != 0.0F) frame.doubted.push_back(k);
  }
}

DERMIS_PROCESSOR_CLONES void SharedErrors::sum_conductances(std::span<const float> of_taxels,
                                                            Frame& frame) const noexcept {
  const std::size_t sensed = sensed_ohm_.size();
  double* const sensed_sum = frame.sensed_sum.data();
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    const float* const line = &of_taxels[at(i, 0)];
    double* const siemens = &frame.siemens[i * sensed];
    for (std::size_t j = 0; j < sensed; ++j) siemens[j] = static_cast<double>(line[j * sensed_step_]);
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t j = 0; j < sensed; ++j) {
      sensed_sum[j] += siemens[j];
      sum += siemens[j];
    }
    frame.driven_sum[i] = sum;
    frame.driven_gain[i] = 1.0 + driven_ohm_[i] * sum;
  }
}

/// With one load w depends on y, which is G w / a here.
void SharedErrors::find_sensed_lines(Frame& frame) const noexcept {
  frame.sensed_gain.assign(sensed_ohm_.size(), 1.0);
  frame.sensed_shunt.assign(sensed_ohm_.size(), 0.0);
  frame.sensed_taken.assign(sensed_ohm_.size(), 0.0);
  for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
    const double sum = frame.sensed_sum[j];
    frame.sensed_gain[j] += sensed_ohm_[j] * sum;
    frame.sensed_shunt[j] = sensed_ohm_[j] / frame.sensed_gain[j];
    if (!one_loaded_ || !(sum > 0.0)) continue;
    frame.sensed_shunt[j] = 1.0 / sum;
    for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
      const double siemens = frame.of_driven(i)[j];
      const double dropped = driven_ohm_[i] * siemens * siemens / frame.driven_gain[i];
      frame.sensed_gain[j] += dropped / sum;
      frame.sensed_taken[j] += siemens / frame.driven_gain[i] + dropped;
    }
  }
}

DERMIS_PROCESSOR_CLONES void SharedErrors::find_own_gains(Frame& frame) const noexcept {
  const std::size_t sensed = sensed_ohm_.size();
  const double* const shunt = frame.sensed_shunt.data();
  frame.own_gain.resize(driven_ohm_.size());
  frame.own_gains = 0.0;
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    const double* const siemens = frame.of_driven(i).data();
    double returned = 0.0;
#pragma omp simd reduction(+ : returned)
    for (std::size_t j = 0; j < sensed; ++j) returned += siemens[j] * siemens[j] * shunt[j];
    frame.own_gain[i] = frame.driven_gain[i] - driven_ohm_[i] * returned;
    frame.own_gains += frame.own_gain[i] * frame.own_gain[i];
  }
  frame.reading_gains = 0.0;
  for (std::size_t j = 0; j < sensed; ++j) frame.reading_gains += square(reading_siemens_[j] * frame.sensed_gain[j]);
}

void SharedErrors::weigh(const Frame& frame, const WeightedConductances& of, Sum& sum) const noexcept {
  sum.of = of;
  sum.driven_weighted.assign(driven_ohm_.size(), 0.0);
  sum.sensed_weighted.assign(sensed_ohm_.size(), 0.0);
  sum.is_driven.assign(driven_ohm_.size(), false);
  for (std::size_t k = 0; k < of.taxels.size(); ++k) {
    const auto [i, j] = lines_[of.taxels[k]];
    const double weighted = of.weight[k] * frame.of_driven(i)[j];
    sum.driven_weighted[i] += driven_ohm_[i] * weighted;
    sum.sensed_weighted[j] += weighted;
    sum.is_driven[i] = true;
  }
}

/// sum_ij r_i^2 q_j^2 (c_ij + u_i + v_j)^2 with r_i = (S D^-1)_ii and q_j = sigma / (gain_j w_j). Where c_ij is 0, the
/// sum over i and that over j are told apart.
double SharedErrors::noise(const ConductanceErrors& errors, const Frame& frame, const Sum& sum) const noexcept {
  double independent = 0.0;
  if (!errors.noise_siemens.empty()) {
    for (std::size_t k = 0; k < sum.of.taxels.size(); ++k) {
      independent += std::pow(sum.of.weight[k] * static_cast<double>(errors.noise_siemens[sum.of.taxels[k]]), 2);
    }
  }
  if (!tells_noise_) return independent;
  double by_driven = 0.0;         // sum_i r_i^2 u_i
  double by_driven_square = 0.0;  // sum_i r_i^2 u_i^2
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    const double shift = frame.own_gain[i] * frame.own_gain[i] * sum.driven_weighted[i];
    by_driven += shift;
    by_driven_square += shift * sum.driven_weighted[i];
  }
  double by_sensed = 0.0;         // sum_j q_j^2 v_j
  double by_sensed_square = 0.0;  // sum_j q_j^2 v_j^2
  for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
    const double through_sensed = sensed_ohm_[j] * sum.sensed_weighted[j];
    const double shift = square(reading_siemens_[j] * frame.sensed_gain[j]) * through_sensed;
    by_sensed += shift;
    by_sensed_square += shift * through_sensed;
  }
  double variance =
      by_driven_square * frame.reading_gains + 2.0 * by_driven * by_sensed + frame.own_gains * by_sensed_square;
  for (std::size_t k = 0; k < sum.of.taxels.size(); ++k) {
    const auto [i, j] = lines_[sum.of.taxels[k]];
    const double alone = reading_siemens_[j] * frame.own_gain[i] * frame.sensed_gain[j];
    const double through_lines = sum.driven_weighted[i] + sensed_ohm_[j] * sum.sensed_weighted[j];
    variance += alone * alone * sum.of.weight[k] * (sum.of.weight[k] + 2.0 * through_lines);
  }
  return independent + errors.sigma_ratio * errors.sigma_ratio * variance;
}

/// sum_ik C_|i-k| g_i g_k, with the shift g_i of the sum where all readings of line i are a standard deviation higher.
double SharedErrors::shared_noise(const ConductanceErrors& errors, const Frame& frame, Sum& sum) const noexcept {
  sum.line_shift.assign(driven_ohm_.size(), 0.0);
  for (std::size_t k = 0; k < sum.of.taxels.size(); ++k) {
    const auto [i, j] = lines_[sum.of.taxels[k]];
    const double of_taxel = tells_noise_ ? reading_siemens_[j] * frame.sensed_gain[j] * errors.sigma_ratio
                                         : static_cast<double>(errors.noise_siemens[sum.of.taxels[k]]);
    sum.line_shift[i] += sum.of.weight[k] * of_taxel;
  }
  if (tells_noise_) shift_through_lines(errors, frame, sum);
  double variance = 0.0;
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    variance += sum.line_shift[i] * with_other_lines(errors.shared_noise, sum.line_shift, i);
  }
  return std::max(variance, 0.0);
}

void SharedErrors::shift_through_lines(const ConductanceErrors& errors, const Frame& frame, Sum& sum) const noexcept {
  double through_sensed = 0.0;  // sum_j q_j v_j
  for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
    through_sensed += reading_siemens_[j] * frame.sensed_gain[j] * sensed_ohm_[j] * sum.sensed_weighted[j];
  }
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    const double through_lines = frame.sum_of_reading_gains * sum.driven_weighted[i] + through_sensed;
    sum.line_shift[i] = frame.own_gain[i] * (sum.line_shift[i] + errors.sigma_ratio * through_lines);
  }
}

/// The same of a taxel ij: g_k = [i = k] alone + r_k lifted, with r_k = (S D^-1)_kk.
void SharedErrors::share_noise(const ConductanceErrors& errors, std::span<double> sigma_siemens) const noexcept {
  if (!tells_noise_ || !is_shared(errors)) return;
  thread_local Frame frame;
  find_lines(errors, frame);
  double of_all = 0.0;  // sum_ik C_|i-k| r_i r_k
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    of_all += frame.own_gain[i] * with_other_lines(errors.shared_noise, frame.own_gain, i);
  }
  const auto common = static_cast<double>(errors.shared_noise.front());
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    const double with_others = with_other_lines(errors.shared_noise, frame.own_gain, i);
    for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
      const double siemens = frame.of_driven(i)[j];
      const double gain = reading_siemens_[j] * frame.sensed_gain[j];
      const double alone = frame.own_gain[i] * (gain + driven_ohm_[i] * siemens * frame.sum_of_reading_gains);
      const double lifted = gain * sensed_ohm_[j] * siemens;
      const double variance = common * alone * alone + 2.0 * alone * lifted * with_others + lifted * lifted * of_all;
      double& sigma = sigma_siemens[at(i, j)];
      sigma =
          std::sqrt((1.0 - common) * sigma * sigma + errors.sigma_ratio * errors.sigma_ratio * std::max(variance, 0.0));
    }
  }
}

double SharedErrors::supply(const ConductanceErrors& errors, const Frame& frame, const Sum& sum) const noexcept {
  const double sigma = std::hypot(supply_noise_, errors.supply_doubt);
  if (sigma == 0.0) return 0.0;
  double shift = 0.0;
  for (std::size_t k = 0; k < sum.of.taxels.size(); ++k) {
    const auto [i, j] = lines_[sum.of.taxels[k]];
    shift += sum.of.weight[k] * frame.of_driven(i)[j] * frame.driven_gain[i] * frame.sensed_gain[j];
  }
  return sigma * sigma * shift * shift;
}

double SharedErrors::estimated_taxels(const ConductanceErrors& errors, const Frame& frame,
                                      const Sum& sum) const noexcept {
  double variance = 0.0;
  for (const std::size_t taxel : frame.doubted) {
    const auto [i, j] = lines_[taxel];
    double shift = sum.driven_weighted[i] + sensed_ohm_[j] * sum.sensed_weighted[j];
    const auto own = std::find(sum.of.taxels.begin(), sum.of.taxels.end(), taxel);
    if (own != sum.of.taxels.end()) shift += sum.of.weight[static_cast<std::size_t>(own - sum.of.taxels.begin())];
    variance += std::pow(static_cast<double>(errors.doubt_siemens[taxel]) * shift, 2);
  }
  return variance;
}

double SharedErrors::drivers(const Frame& frame, Sum& sum) const noexcept {
  double common = 0.0;
  double square = 0.0;
  for (std::size_t k = 0; k < drive_error_ohm_.size(); ++k) {
    const double shift = drive_error_ohm_[k] * driver_shift(k, frame, sum);
    common += shift;
    square += shift * shift;
  }
  return correlation_ * common * common + (1.0 - correlation_) * square;
}

/// sum_i L_ik (sum_j c_ij p_kj + u_i sum_j p_kj) + sum_j (sum_i c_ij G_ij) c_kj - sum_j c_kj G_kj^2; DriverError names
/// the symbols.
double SharedErrors::driver_shift(std::size_t driver, const Frame& frame, Sum& sum) const noexcept {
  const std::span<const double> of_driver = frame.of_driven(driver);
  const double gain = frame.driven_gain[driver];
  find_lifts(driver, frame, sum);
  double shift = 0.0;
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    shift += sum.lift[i] * sum.driven_weighted[i] * frame.driven_sum[driver] / gain;
  }
  for (std::size_t k = 0; k < sum.of.taxels.size(); ++k) {
    const auto [i, j] = lines_[sum.of.taxels[k]];
    shift += sum.lift[i] * sum.of.weight[k] * of_driver[j] / gain;
    if (i == driver) shift -= sum.of.weight[k] * of_driver[j] * of_driver[j];
  }
  double sum_of_lifts = frame.driven_sum[driver];
  for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
    sum_of_lifts -= frame.sensed_sum[j] * frame.sensed_shunt[j] * of_driver[j];
  }
  for (std::size_t j = 0; j < sensed_ohm_.size(); ++j) {
    const double taken = frame.sensed_taken[j];
    const double of_one_load = taken > 0.0 ? of_driver[j] * of_driver[j] / (gain * taken) : 0.0;
    const double share = one_loaded_ ? of_one_load : sensed_ohm_[j] * of_driver[j] / gain * sum_of_lifts;
    shift += sum.sensed_weighted[j] * share;
  }
  return shift;
}

/// L_ik = [i = k] sum_j G_kj - sum_j G_ij eta_j G_kj, of the lines that the sum counts.
void SharedErrors::find_lifts(std::size_t driver, const Frame& frame, Sum& sum) const noexcept {
  const std::span<const double> of_driver = frame.of_driven(driver);
  sum.lift.assign(driven_ohm_.size(), 0.0);
  for (std::size_t i = 0; i < driven_ohm_.size(); ++i) {
    if (!sum.is_driven[i]) continue;
    const std::span<const double> siemens = frame.of_driven(i);
    for (std::size_t j = 0; j < siemens.size(); ++j) sum.lift[i] -= siemens[j] * frame.sensed_shunt[j] * of_driver[j];
    if (i == driver) sum.lift[i] += frame.driven_sum[driver];
  }
}

}  // namespace dermis::touch::compensation
