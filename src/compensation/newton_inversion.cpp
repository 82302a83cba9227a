// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/newton_inversion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "compensation/sensed_line.hpp"

namespace dermis::compensation {
namespace {

constexpr int kMaxSteps = 80;
constexpr double kLongestStep = 2.0;              // of x: a factor of e^2 where x is a logarithm
constexpr double kShortestFraction = 1.0 / 64.0;  // of a step
constexpr double kLeastOpenShare = 1e-9;  // of the supply that a reading leaves to its taxel; less is no solution
constexpr double kRounding = 1e-13;       // of the largest reading: what remains of a residual in double precision
constexpr double kRoundingMerit = 1e-9;   // below it a step that does not halve the misfits is rounding
constexpr double kMostSiemens = 1e3;
constexpr double kLeastOwnShare = 1e-3;  // of a taxel in its reading that the scaling of the equations counts on

}  // namespace

double NewtonInversion::Reading::scaled(double ratio) const noexcept {
  const double current = (ratio - offset) / gain;
  const double siemens = current / std::max(1.0 - series * current, kLeastOpenShare);
  return std::asinh(siemens / (2.0 * noise));
}

double NewtonInversion::Reading::slope(double ratio) const noexcept {
  const double current = (ratio - offset) / gain;
  const double open = std::max(1.0 - series * current, kLeastOpenShare);
  return 1.0 / (gain * open * open * std::hypot(current / open, 2.0 * noise));
}

double NewtonInversion::Reading::open_slope(double ratio) const noexcept {
  const double open = std::max(1.0 - series * (ratio - offset) / gain, kLeastOpenShare);
  return gain * open * open;
}

double NewtonInversion::Reading::siemens(double x) const noexcept {
  return std::min(2.0 * noise * std::sinh(x), kMostSiemens);
}

double NewtonInversion::Reading::siemens_slope(double x) const noexcept {
  return 2.0 * noise * std::cosh(x);
}

NewtonInversion::NewtonInversion(const ArrayDescription& array, CircuitModel model, double tolerance_ratio)
    : model_(std::move(model)), solver_(array.taxel_count()), tolerance_(tolerance_ratio) {
  const Readout& readout = array.readout;
  const double noise_ratio = readout.adc_noise_counts / readout.full_scale_counts();
  const bool columns_are_driven = readout.circuit == Circuit::flexitac;
  for (std::size_t row = 0; row < array.rows; ++row) {
    for (std::size_t col = 0; col < array.cols; ++col) {
      const SensedLine sensed = sensed_line(readout, columns_are_driven ? row : col);
      const double drive = readout.drive_ohm[columns_are_driven ? col : row];
      readings_.push_back({sensed.gain, sensed.offset, drive + sensed.rho, noise_ratio / sensed.gain});
    }
  }
  for (auto* values : {&measured_, &x_, &trial_, &siemens_, &misfit_, &own_slope_, &row_scale_, &column_scale_, &right_,
                       &change_, &last_shift_}) {
    values->resize(array.taxel_count());
  }
  held_.resize(array.taxel_count());
}

double NewtonInversion::siemens_per_ratio() const noexcept {
  double largest = 0.0;
  for (const Reading& reading : readings_) largest = std::max(largest, 1.0 / reading.gain);
  return largest;
}

InversionResult NewtonInversion::invert(std::span<const double> ratio, std::span<double> siemens) noexcept {
  if (!std::all_of(ratio.begin(), ratio.end(), [](double value) { return std::isfinite(value); })) {
    std::fill(siemens.begin(), siemens.end(), 0.0);
    return {false, std::numeric_limits<double>::infinity()};
  }
  ratio_ = ratio;
  for (std::size_t k = 0; k < ratio.size(); ++k) measured_[k] = readings_[k].scaled(ratio[k]);
  bool solved = false;
  if (has_last_frame_) {
    start(true);
    solved = iterate();
  }
  if (!solved) {
    start(false);
    solved = iterate();
  }
  std::copy(siemens_.begin(), siemens_.end(), siemens.begin());
  if (solved) {
    for (std::size_t k = 0; k < ratio.size(); ++k) last_shift_[k] = x_[k] - measured_[k];
    has_last_frame_ = true;
  }
  return {solved, residual_ratio()};
}

// A taxel that is pressed between two frames changes its reading: its correction of the last frame is kept, not itself.
void NewtonInversion::start(bool from_last_frame) noexcept {
  for (std::size_t k = 0; k < x_.size(); ++k) {
    x_[k] = std::max(measured_[k] + (from_last_frame ? last_shift_[k] : 0.0), 0.0);
  }
  solve_at(x_);
}

bool NewtonInversion::iterate() noexcept {
  double largest = 0.0;
  for (const double value : ratio_) largest = std::max(largest, std::abs(value));
  for (int k = 0; k < kMaxSteps; ++k) {
    if (tolerance_ > 0.0 && residual_ratio() <= tolerance_) return true;
    if (!step()) break;
  }
  return residual_ratio() <= std::max(tolerance_, kRounding * largest);
}

void NewtonInversion::solve_at(std::span<const double> x) noexcept {
  for (std::size_t k = 0; k < x.size(); ++k) siemens_[k] = readings_[k].siemens(x[k]);
  model_.solve(siemens_);
  for (std::size_t k = 0; k < x.size(); ++k) misfit_[k] = measured_[k] - readings_[k].scaled(model_.ratio()[k]);
}

double NewtonInversion::merit() const noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < x_.size(); ++k) {
    const double wrong = std::max(misfit_[k], -x_[k]);
    sum += wrong * wrong;
  }
  return std::sqrt(sum);
}

double NewtonInversion::residual_ratio() const noexcept {
  double largest = 0.0;
  for (std::size_t k = 0; k < x_.size(); ++k) {
    const double difference = ratio_[k] - model_.ratio()[k];
    largest = std::max(largest, x_[k] > 0.0 ? std::abs(difference) : difference);
  }
  return largest;
}

// A weak taxel adds to what flows around it: its reading is linear in its conductance up to that of the reading.
double NewtonInversion::moved(std::size_t taxel, double x, double change) const noexcept {
  if (change <= 0.0) return std::max(x + std::max(change, -kLongestStep), 0.0);
  const double linear = std::asinh(std::sinh(x) + change * std::cosh(x));
  return std::min(linear, std::max(x, measured_[taxel]) + kLongestStep);
}

bool NewtonInversion::step() noexcept {
  const std::size_t taxels = x_.size();
  model_.own_derivatives(own_slope_);
  for (std::size_t k = 0; k < taxels; ++k) {
    const double slope = readings_[k].slope(model_.ratio()[k]);
    held_[k] = x_[k] + misfit_[k] <= 0.0;
    row_scale_[k] = held_[k] ? 0.0 : slope;
    column_scale_[k] =
        1.0 / (slope * std::max(own_slope_[k], kLeastOwnShare * readings_[k].open_slope(model_.ratio()[k])));
    right_[k] = held_[k] ? -siemens_[k] / column_scale_[k] : misfit_[k];
  }
  const auto product = [&](std::span<const double> in, std::span<double> out) {
    for (std::size_t k = 0; k < taxels; ++k) trial_[k] = in[k] * column_scale_[k];
    model_.multiply_taxel_jacobian(trial_, out);
    for (std::size_t k = 0; k < taxels; ++k) out[k] = held_[k] ? in[k] : out[k] * row_scale_[k];
  };
  const double before = merit();
  const double accuracy = std::clamp(0.1 * before / std::sqrt(static_cast<double>(taxels)), 1e-6, 1e-2);
  solver_.solve(product, right_, change_, accuracy);
  for (std::size_t k = 0; k < taxels; ++k) {
    change_[k] = held_[k] ? -x_[k] : change_[k] * column_scale_[k] / readings_[k].siemens_slope(x_[k]);
  }
  std::copy(x_.begin(), x_.end(), trial_.begin());
  for (double fraction = 1.0; fraction >= kShortestFraction; fraction *= 0.5) {
    for (std::size_t k = 0; k < taxels; ++k) x_[k] = moved(k, trial_[k], fraction * change_[k]);
    solve_at(x_);
    const double after = merit();
    if (after < before) return after > kRoundingMerit || after < 0.5 * before;
  }
  x_ = trial_;
  solve_at(x_);
  return false;
}

void NewtonInversion::propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept {
  model_.own_derivatives(sigma_siemens);
  for (double& sigma : sigma_siemens) sigma = sigma_ratio / sigma;
}

}  // namespace dermis::compensation
