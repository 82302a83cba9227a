// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/grounded_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dermis::compensation {
namespace {

constexpr int kPlainSteps = 24;
constexpr double kShrinks = 0.7;  // of the certificate in a step; what shrinks less is left to the mixing
constexpr int kMixedSteps = 400;
constexpr int kStepsWithoutGain = 60;
constexpr int kRoundedStepsWithoutGain = 5;
constexpr double kRounded = 1e-12;  // certificate; what is left of it is rounding
constexpr std::size_t kMixingDepth = 8;
constexpr double kLeastSiemens = 1e-12;  // held at 0 below
constexpr double kMostLogStep = 2.0;
constexpr double kMostLogResidual = 2.302585092994046;  // ln 10

}  // namespace

GroundedRows::GroundedRows(const ArrayDescription& array, double tolerance_ratio)
    : tolerance_(tolerance_ratio),
      state_(array.rows, array.cols, array.readout.idle_columns),
      last_estimate_(state_.siemens.size()),
      best_siemens_(state_.siemens.size()),
      best_explained_(state_.siemens.size()),
      mixing_(state_.siemens.size(), kMixingDepth),
      log_siemens_(state_.siemens.size()),
      last_log_siemens_(state_.siemens.size()),
      log_step_(state_.siemens.size()) {
  state_.drive_ohm = array.readout.drive_ohm;
  const double weakest_driver = *std::max_element(state_.drive_ohm.begin(), state_.drive_ohm.end());
  for (std::size_t col = 0; col < array.cols; ++col) {
    const double load_ohm = array.readout.load_ohm[col];
    const bool one_loaded = state_.idle_columns == IdleColumns::floating;
    reading_siemens_.push_back(1.0 / load_ohm);
    state_.column_ohm[col] = load_ohm;
    state_.certificate_ratio[col] = load_ohm * (one_loaded ? 1.0 + weakest_driver / load_ohm : 1.0);
  }
}

double GroundedRows::siemens_per_ratio() const noexcept {
  return *std::max_element(reading_siemens_.begin(), reading_siemens_.end());
}

InversionResult GroundedRows::invert(std::span<const double> ratio, std::span<double> siemens) noexcept {
  std::swap(state_.estimate, last_estimate_);
  load(ratio);
  estimate_from_readings(state_);
  if (has_last_) {
    start_warm(state_, last_estimate_);
  } else {
    start_cold(state_);
  }
  double certificate = iterate();
  if (!(certificate <= tolerance_)) certificate = iterate_with_mixing(certificate);
  has_last_ = certificate <= std::max(tolerance_, kRounded);
  for (std::size_t row = 0; row < state_.rows; ++row) {
    std::copy_n(&state_.siemens[row * state_.stride], state_.cols, &siemens[row * state_.cols]);
  }
  return {has_last_, certificate};
}

void GroundedRows::load(std::span<const double> ratio) noexcept {
  for (std::size_t row = 0; row < state_.rows; ++row) {
    for (std::size_t col = 0; col < state_.cols; ++col) {
      state_.measured[row * state_.stride + col] = reading_siemens_[col] * ratio[row * state_.cols + col];
    }
  }
}

/// Certificate of the iterate that it ends with.
double GroundedRows::iterate() noexcept {
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0;; ++step) {
    const double certificate = assess(state_);
    if (certificate <= tolerance_) return certificate;
    if (step > 0 && !(certificate < last)) break;
    keep();
    if (step == kPlainSteps || certificate > kShrinks * last) return certificate;
    last = certificate;
    advance(state_);
  }
  state_.siemens = best_siemens_;
  state_.explained = best_explained_;
  return last;
}

void GroundedRows::keep() noexcept {
  best_siemens_ = state_.siemens;
  best_explained_ = state_.explained;
}

double GroundedRows::iterate_with_mixing(double best) noexcept {
  for (std::size_t k = 0; k < log_siemens_.size(); ++k) {
    log_siemens_[k] = std::log(std::max(state_.estimate[k], kLeastSiemens));
  }
  mixing_.forget();
  int without_gain = 0;
  for (int step = 0; step < kMixedSteps && best > tolerance_; ++step) {
    take_step();
    const double certificate = assess(state_);
    if (certificate < best) {
      best = certificate;
      keep();
      without_gain = 0;
    }
    if (++without_gain > (best <= kRounded ? kRoundedStepsWithoutGain : kStepsWithoutGain)) break;
    choose_step();
  }
  state_.siemens = best_siemens_;
  state_.explained = best_explained_;
  return best;
}

/// G and y' of ln G.
void GroundedRows::take_step() noexcept {
  const double least = std::log(kLeastSiemens);
  for (std::size_t row = 0; row < state_.rows; ++row) {
    for (std::size_t col = 0; col < state_.stride; ++col) {
      const std::size_t k = row * state_.stride + col;
      const bool held = log_siemens_[k] <= least;
      const double caused = state_.returned[k] / state_.line_gain[row];
      state_.siemens[k] = held ? 0.0 : std::exp(log_siemens_[k]);
      state_.explained[k] = held ? std::max(state_.measured[k], caused) : state_.measured[k];
    }
  }
  refresh(state_);
}

/// The next ln G.
void GroundedRows::choose_step() noexcept {
  bool near = true;
  for (std::size_t row = 0; row < state_.rows; ++row) {
    for (std::size_t col = 0; col < state_.stride; ++col) {
      const std::size_t k = row * state_.stride + col;
      const double undriven = state_.line_gain[row] * state_.measured[k] - state_.returned[k];
      const double next = std::max(state_.column_scale[col] * undriven, kLeastSiemens);
      const double change = std::log(next / std::max(state_.siemens[k], kLeastSiemens));
      log_step_[k] = std::clamp(change, -kMostLogResidual, kMostLogResidual);
      near = near && std::abs(change) < kMostLogResidual;
    }
  }
  if (!near) mixing_.forget();
  last_log_siemens_ = log_siemens_;
  mixing_.advance(log_siemens_, log_step_);
  for (std::size_t k = 0; k < log_siemens_.size(); ++k) {
    const double last = last_log_siemens_[k];
    log_siemens_[k] = std::clamp(log_siemens_[k], last - kMostLogStep, last + kMostLogStep);
    log_siemens_[k] = std::max(log_siemens_[k], std::log(kLeastSiemens));
  }
}

void GroundedRows::propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept {
  for (std::size_t k = 0; k < sigma_siemens.size(); ++k) {
    const std::size_t row = k / state_.cols;
    const std::size_t col = k % state_.cols;
    sigma_siemens[k] = sigma_ratio * reading_siemens_[col] * state_.line_gain[row] / state_.column_part[col];
  }
}

}  // namespace dermis::compensation
