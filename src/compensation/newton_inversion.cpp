// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/newton_inversion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "compensation/matrix_product.hpp"
#include "compensation/readout_parts.hpp"
#include "compensation/sensed_line.hpp"

namespace dermis::compensation {
namespace {

constexpr int kMaxSteps = 80;
constexpr double kLongestStep = 2.0;             // of x: a factor of e^2 where x is a logarithm
constexpr double kShortestFraction = 1.0 / 8.0;  // of a step
constexpr double kLeastDamping = 1e-3;
constexpr double kMostDamping = 1e3;
constexpr double kDampingFactor = 10.0;
constexpr int kBoldSteps = 5;             // that may lead uphill, where no way down was found from the start
constexpr double kBoldRise = 4.0;         // of the misfits
constexpr double kLeastOpenShare = 1e-9;  // of the supply that a reading leaves to its taxel; less is no solution
constexpr double kRounding = 1e-13;       // of the largest reading: what remains of a residual in double precision
constexpr double kRoundingMerit = 1e-12;  // below it a step that does not halve the misfits is rounding
// Of the solution of a step's equations: the better, the nearer the solution is.
constexpr double kAccuracy = 0.1;
constexpr double kBestAccuracy = 1e-6;
constexpr double kLeastAccuracy = 1e-2;
constexpr double kMostSiemens = 1e3;
constexpr double kShareOfTolerance = 0.1;  // to which floating rows are solved without Newton's method
constexpr double kFineEnough = 1e-9;       // and where it goes on in any case
constexpr double kNear = 1e-2;             // a last pass that its own steps need not start anew after
constexpr double kLeastOwnShare = 1e-3;    // of a taxel in its reading that the scaling of the equations counts on

constexpr std::size_t kMostInvertedTaxels = 400;
constexpr int kNoiseSamples = 12;
constexpr std::uint64_t kNoiseSeed = 1;

double random_sign(Random& random) noexcept {
  return random.below(2) == 0 ? 1.0 : -1.0;
}

}  // namespace

double NewtonInversion::Reading::apparent_siemens(double ratio) const noexcept {
  const double current = (ratio - offset) / gain;
  return current / std::max(1.0 - series * current, kLeastOpenShare);
}

double NewtonInversion::Reading::scaled(double ratio) const noexcept {
  return scaled_siemens(apparent_siemens(ratio));
}

double NewtonInversion::Reading::scaled_siemens(double siemens) const noexcept {
  return std::asinh(siemens / (2.0 * scale));
}

double NewtonInversion::Reading::slope(double ratio) const noexcept {
  return 1.0 / (open_slope(ratio) * std::hypot(apparent_siemens(ratio), 2.0 * scale));
}

double NewtonInversion::Reading::open_slope(double ratio) const noexcept {
  const double open = std::max(1.0 - series * (ratio - offset) / gain, kLeastOpenShare);
  return gain * open * open;
}

double NewtonInversion::Reading::siemens(double x) const noexcept {
  return std::min(2.0 * scale * std::sinh(x), kMostSiemens);
}

double NewtonInversion::Reading::siemens_slope(double x) const noexcept {
  return 2.0 * scale * std::cosh(x);
}

NewtonInversion::NewtonInversion(const ArrayDescription& array, CircuitModel model, double tolerance_ratio,
                                 const InversionOptions& options)
    : model_(std::move(model)),
      solver_(array.taxel_count()),
      tolerance_(tolerance_ratio),
      most_steps_(options.most_steps.value_or(std::numeric_limits<int>::max())),
      drive_error_correlation_(array.readout.drive_error_correlation) {
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
  for (auto* values : {&measured_, &x_, &last_x_, &scaled_, &siemens_, &misfit_, &own_slope_, &row_scale_,
                       &column_scale_, &right_, &solution_, &change_, &last_shift_}) {
    values->resize(array.taxel_count());
  }
  held_.resize(array.taxel_count());
  if (!options.samples_noise && x_.size() <= kMostInvertedTaxels) inverse_ = std::make_unique<DenseInverse>(x_.size());
  if (options.counts_driver_errors && !is_absent(readout.drive_error_ohm)) {
    drive_error_ohm_ = readout.drive_error_ohm;
    drawn_ohm_.resize(drive_error_ohm_.size());
    drive_slope_.resize(x_.size() * drive_error_ohm_.size());
    if (inverse_) drive_change_.resize(drive_slope_.size());
  }
  if (FloatingRows::inverts(readout)) floating_rows_ = std::make_unique<FloatingRows>(array);
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
  steps_left_ = most_steps_;
  for (std::size_t k = 0; k < ratio.size(); ++k) {
    readings_[k].scale = std::max(readings_[k].noise, -readings_[k].apparent_siemens(ratio[k]));
    measured_[k] = readings_[k].scaled(ratio[k]);
  }
  const bool solved = solve();
  std::copy(siemens_.begin(), siemens_.end(), siemens.begin());
  if (solved) {
    for (std::size_t k = 0; k < ratio.size(); ++k) last_shift_[k] = x_[k] - measured_[k];
    has_last_frame_ = true;
  }
  return {solved, residual_ratio()};
}

bool NewtonInversion::solve() noexcept {
  if (floating_rows_) {
    if (!floating_rows_->allows(ratio_)) {
      start(false);
      return false;
    }
    const double moved = floating_rows_->solve(ratio_, std::max(kShareOfTolerance * tolerance_, kFineEnough), siemens_);
    if (moved <= kNear) {
      start_at_siemens();
      if (iterate(0)) return true;
    }
  }
  if (has_last_frame_) {
    start(true);
    if (iterate(0)) return true;
  }
  for (const int bold_steps : {0, kBoldSteps}) {
    start(false);
    if (iterate(bold_steps)) return true;
  }
  return false;
}

void NewtonInversion::forget() noexcept {
  has_last_frame_ = false;
  if (floating_rows_) floating_rows_->forget();
}

// A taxel that is pressed between two frames changes its reading: its correction of the last frame is kept, not itself.
void NewtonInversion::start(bool from_last_frame) noexcept {
  for (std::size_t k = 0; k < x_.size(); ++k) {
    x_[k] = std::max(measured_[k] + (from_last_frame ? last_shift_[k] : 0.0), 0.0);
  }
  solve_at(x_);
  damping_ = 0.0;
}

void NewtonInversion::start_at_siemens() noexcept {
  for (std::size_t k = 0; k < x_.size(); ++k) x_[k] = readings_[k].scaled_siemens(siemens_[k]);
  solve_at(x_);
  damping_ = 0.0;
}

bool NewtonInversion::iterate(int bold_steps) noexcept {
  double largest = 0.0;
  for (const double value : ratio_) largest = std::max(largest, std::abs(value));
  for (int k = 0; k < kMaxSteps; ++k) {
    if (tolerance_ > 0.0 && residual_ratio() <= tolerance_) return true;
    if (--steps_left_ < 0 || !step(k < bold_steps ? kBoldRise : 1.0)) break;
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
  const double linear = std::asinh(std::sinh(x) + change * std::cosh(x));
  return std::clamp(linear, std::max(x - kLongestStep, 0.0), std::max(x, measured_[taxel]) + kLongestStep);
}

bool NewtonInversion::step(double allowed_rise) noexcept {
  scale_equations();
  std::copy(x_.begin(), x_.end(), last_x_.begin());
  const double before = merit();
  const double accuracy = kAccuracy * before / std::sqrt(static_cast<double>(x_.size()));
  for (; damping_ <= kMostDamping; damping_ = std::max(kLeastDamping, kDampingFactor * damping_)) {
    solve_equations(std::clamp(accuracy, kBestAccuracy, kLeastAccuracy));
    for (std::size_t k = 0; k < x_.size(); ++k) {
      change_[k] = held_[k] ? -x_[k] : solution_[k] * column_scale_[k] / readings_[k].siemens_slope(x_[k]);
    }
    for (double fraction = 1.0; fraction >= kShortestFraction; fraction *= 0.5) {
      for (std::size_t k = 0; k < x_.size(); ++k) x_[k] = moved(k, last_x_[k], fraction * change_[k]);
      solve_at(x_);
      const double after = merit();
      if (!(after < allowed_rise * before)) continue;
      damping_ = damping_ > kLeastDamping ? damping_ / kDampingFactor : 0.0;
      return after > kRoundingMerit || after < 0.5 * before;
    }
    std::copy(last_x_.begin(), last_x_.end(), x_.begin());
    solve_at(x_);
    if (before < kRoundingMerit) return false;
  }
  return false;
}

void NewtonInversion::scale_equations() noexcept {
  model_.own_derivatives(own_slope_);
  for (std::size_t k = 0; k < x_.size(); ++k) {
    const double slope = readings_[k].slope(model_.ratio()[k]);
    const double least_own_slope = kLeastOwnShare * readings_[k].open_slope(model_.ratio()[k]);
    row_scale_[k] = slope;
    column_scale_[k] = 1.0 / (slope * std::max(own_slope_[k], least_own_slope));
    held_[k] = x_[k] + misfit_[k] <= 0.0;
    right_[k] = held_[k] ? -siemens_[k] / column_scale_[k] : misfit_[k];
  }
}

void NewtonInversion::solve_equations(double accuracy) noexcept {
  const std::size_t taxels = x_.size();
  const auto product = [&](std::span<const double> in, std::span<double> out) {
    for (std::size_t k = 0; k < taxels; ++k) scaled_[k] = in[k] * column_scale_[k];
    model_.multiply_taxel_jacobian(scaled_, out);
    for (std::size_t k = 0; k < taxels; ++k) out[k] = held_[k] ? in[k] : out[k] * row_scale_[k] + damping_ * in[k];
  };
  solver_.solve(product, right_, solution_, accuracy);
}

// In units of x, with B = (d x / d ratio) J (d siemens / d x): the sums of squares of the rows of B^-1 (d x / d ratio).
// A driver that is wrong by s moves all taxels by -B^-1 (d x / d ohm) s, with the readings fixed.
void NewtonInversion::propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept {
  scale_equations();
  find_drive_slopes();
  std::fill(sigma_siemens.begin(), sigma_siemens.end(), 0.0);
  if (inverse_) {
    add_exact_variance(sigma_ratio, sigma_siemens);
    if (!drive_error_ohm_.empty()) add_exact_driver_variance(sigma_siemens);
  } else {
    add_sampled_variance(sigma_ratio, sigma_siemens);
  }
  for (std::size_t k = 0; k < x_.size(); ++k) {
    const double sigma = column_scale_[k] * std::sqrt(sigma_siemens[k]);
    sigma_siemens[k] = sigma < kMostSiemens ? sigma : kMostSiemens;  // also where nothing is known: not a number
  }
}

void NewtonInversion::find_drive_slopes() noexcept {
  if (drive_error_ohm_.empty()) return;
  model_.drive_jacobian(drive_slope_);
  const std::size_t drivers = drive_error_ohm_.size();
  for (std::size_t k = 0; k < drive_slope_.size(); ++k) drive_slope_[k] *= row_scale_[k / drivers];
}

void NewtonInversion::add_exact_variance(double sigma_ratio, std::span<double> variance) noexcept {
  const std::size_t taxels = x_.size();
  auto& matrix = inverse_->matrix();
  model_.taxel_jacobian({matrix.data(), taxels * taxels});
  const Eigen::Map<const Eigen::VectorXd> row_scale(row_scale_.data(), matrix.rows());
  const Eigen::Map<const Eigen::VectorXd> column_scale(column_scale_.data(), matrix.cols());
  for (Eigen::Index k = 0; k < matrix.rows(); ++k) {
    matrix.row(k).array() *= row_scale(k) * column_scale.transpose().array();
  }
  inverse_->invert();
  for (Eigen::Index k = 0; k < matrix.rows(); ++k) {
    const double square = matrix.row(k).cwiseProduct(row_scale.transpose()).squaredNorm();
    variance[static_cast<std::size_t>(k)] += sigma_ratio * sigma_ratio * square;
  }
}

void NewtonInversion::add_exact_driver_variance(std::span<double> variance) noexcept {
  const std::size_t taxels = x_.size();
  const std::size_t drivers = drive_error_ohm_.size();
  multiply({inverse_->matrix().data(), taxels, 1}, drive_slope_.data(), taxels, taxels, drivers, drive_change_.data());
  for (std::size_t k = 0; k < taxels; ++k) {
    double common = 0.0;
    double square = 0.0;
    for (std::size_t driver = 0; driver < drivers; ++driver) {
      const double own = driver == readings_[k].driver ? alone(k) : 0.0;
      const double error = drive_error_ohm_[driver] * (-drive_change_[k * drivers + driver] - own);
      common += error;
      square += error * error;
    }
    variance[k] += drive_error_correlation_ * common * common + (1.0 - drive_error_correlation_) * square;
  }
}

/// What an ohm of its driver does to a taxel that is pressed alone: its calibration has learned that with its law.
double NewtonInversion::alone(std::size_t taxel) const noexcept {
  return siemens_[taxel] * siemens_[taxel] / column_scale_[taxel];
}

// The variance of a taxel over readings and drivers of random signs.
void NewtonInversion::add_sampled_variance(double sigma_ratio, std::span<double> variance) noexcept {
  Random random(kNoiseSeed);
  damping_ = 0.0;
  std::fill(held_.begin(), held_.end(), false);
  const std::size_t drivers = drive_error_ohm_.size();
  for (int sample = 0; sample < kNoiseSamples; ++sample) {
    for (std::size_t k = 0; k < x_.size(); ++k) right_[k] = random_sign(random) * sigma_ratio * row_scale_[k];
    draw_drivers(random);
    for (std::size_t k = 0; k < drive_slope_.size(); ++k) {
      right_[k / drivers] -= drive_slope_[k] * drawn_ohm_[k % drivers];
    }
    solve_equations(kLeastAccuracy);
    for (std::size_t k = 0; k < x_.size(); ++k) {
      const double own = drivers > 0 ? alone(k) * drawn_ohm_[readings_[k].driver] : 0.0;
      variance[k] += (solution_[k] - own) * (solution_[k] - own) / kNoiseSamples;
    }
  }
}

void NewtonInversion::draw_drivers(Random& random) noexcept {
  if (drawn_ohm_.empty()) return;
  const double common = std::sqrt(drive_error_correlation_) * random_sign(random);
  const double own = std::sqrt(1.0 - drive_error_correlation_);
  for (std::size_t driver = 0; driver < drawn_ohm_.size(); ++driver) {
    drawn_ohm_[driver] = drive_error_ohm_[driver] * (common + own * random_sign(random));
  }
}

}  // namespace dermis::compensation
