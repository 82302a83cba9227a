// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/newton_inversion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dermis::touch::compensation {
namespace {

constexpr int kMaxSteps = 80;
constexpr double kMostWork = 320.0;              // of a frame where steps are bounded: solutions of the circuit
constexpr double kWork = 5.0;                    // of each on average
constexpr double kHardFrames = 64.0;             // that may follow each other, as presses of one frame do
constexpr double kFilmWork = 4.0;                // times as much under a film
constexpr double kLongestStep = 2.0;             // of x: a factor of e^2 where x is a logarithm
constexpr double kShortestFraction = 1.0 / 8.0;  // of a step
constexpr double kLeastDamping = 1e-3;
constexpr double kMostDamping = 1e3;
constexpr double kDampingFactor = 10.0;
constexpr int kBoldSteps = 5;             // that may lead uphill, where no way down was found from the start
constexpr double kBoldRise = 4.0;         // of the misfits
constexpr double kRounding = 1e-13;       // of the largest reading: what remains of a residual in double precision
constexpr double kRoundingMerit = 1e-12;  // below it a step that does not halve the misfits is rounding
// Accuracy of a step's equations: the better, the nearer the solution is.
constexpr double kAccuracy = 0.1;
constexpr double kBestAccuracy = 1e-6;
constexpr double kLeastAccuracy = 1e-2;
constexpr double kShareOfTolerance =
    0.1;                              // to which floating rows are solved without Newton's method; not under a film
constexpr double kFineEnough = 1e-9;  // and where it goes on in any case
constexpr double kNear = 1e-2;        // a last pass that its own steps need not start anew after

}  // namespace

NewtonInversion::NewtonInversion(const ArrayDescription& array, CircuitModel model, double tolerance_ratio,
                                 const InversionOptions& options)
    : circuit_(array, std::move(model), options.references),
      equations_(circuit_),
      driver_errors_(array, options.counts_driver_errors),
      noise_(make_newton_noise(circuit_, equations_, driver_errors_, options)),
      tolerance_(tolerance_ratio),
      budget_(options.is_bounded ? (circuit_.has_film() ? kFilmWork : 1.0) * kMostWork : 0.0,
              (circuit_.has_film() ? kFilmWork : 1.0) * kWork, kHardFrames),
      most_steps_(options.most_steps.value_or(std::numeric_limits<int>::max())),
      last_x_(array.taxel_count()),
      change_(array.taxel_count()),
      last_shift_(array.taxel_count()) {
  if (FloatingRows::inverts(array.readout)) {
    floating_rows_ = std::make_unique<FloatingRows>(array, options.references);
  }
}

double NewtonInversion::siemens_per_ratio() const noexcept {
  double largest = 0.0;
  for (const ReadingScale& reading : circuit_.readings()) largest = std::max(largest, 1.0 / reading.gain);
  return largest;
}

InversionResult NewtonInversion::invert(std::span<const double> ratio, std::span<double> siemens) noexcept {
  if (std::any_of(ratio.begin(), ratio.end(), [](double value) { return std::isinf(value); })) {
    std::fill(siemens.begin(), siemens.end(), 0.0);
    return {false, std::numeric_limits<double>::infinity()};
  }
  circuit_.set_frame(ratio, siemens);
  steps_left_ = most_steps_;
  const bool solved = solve(ratio, siemens);
  std::copy(circuit_.siemens().begin(), circuit_.siemens().end(), siemens.begin());
  const bool is_cut_short = !solved && budget_.is_used_up();
  if (solved || (is_cut_short && circuit_.residual_ratio() <= kMostLeft)) {
    for (std::size_t k = 0; k < ratio.size(); ++k) last_shift_[k] = circuit_.x()[k] - circuit_.measured()[k];
    has_last_frame_ = true;
  }
  if (solved) budget_.learn();
  return {solved, circuit_.residual_ratio(), is_cut_short};
}

bool NewtonInversion::solve(std::span<const double> ratio, std::span<const double> siemens) noexcept {
  if (floating_rows_) {
    if (!floating_rows_->allows(ratio)) {
      start(false);
      return false;
    }
    std::copy(siemens.begin(), siemens.end(), circuit_.siemens().begin());
    const double enough = (circuit_.has_film() ? 1.0 : kShareOfTolerance) * tolerance_;
    const double moved = floating_rows_->solve(ratio, std::max(enough, kFineEnough), circuit_.siemens());
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

void NewtonInversion::hold_film(const FilmConductances& film) noexcept {
  circuit_.hold_film(film);
  if (floating_rows_) floating_rows_->hold_film(film);
}

void NewtonInversion::forget() noexcept {
  has_last_frame_ = false;
  budget_.forget();
  if (floating_rows_) floating_rows_->forget();
}

// A taxel that is pressed between two frames changes its reading: its correction of the last frame is kept, not itself.
void NewtonInversion::start(bool from_last_frame) noexcept {
  std::vector<double>& x = circuit_.x();
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k] = std::max(circuit_.measured()[k] + (from_last_frame ? last_shift_[k] : 0.0), 0.0);
  }
  circuit_.solve();
  damping_ = 0.0;
}

void NewtonInversion::start_at_siemens() noexcept {
  std::vector<double>& x = circuit_.x();
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = circuit_.readings()[k].scaled_siemens(circuit_.siemens()[k]);
  circuit_.solve();
  damping_ = 0.0;
}

bool NewtonInversion::iterate(int bold_steps) noexcept {
  for (int k = 0; k < kMaxSteps; ++k) {
    if (tolerance_ > 0.0 && circuit_.residual_ratio() <= tolerance_) return true;
    if (budget_.is_used_up() || --steps_left_ < 0 || !step(k < bold_steps ? kBoldRise : 1.0)) break;
  }
  return circuit_.residual_ratio() <= std::max(tolerance_, kRounding * circuit_.largest_ratio());
}

// A weak taxel adds to what flows around it: its reading is linear in its conductance up to that of the reading.
double NewtonInversion::moved(std::size_t taxel, double x, double change) const noexcept {
  const double linear = std::asinh(std::sinh(x) + change * std::cosh(x));
  return std::clamp(linear, std::max(x - kLongestStep, 0.0), std::max(x, circuit_.measured()[taxel]) + kLongestStep);
}

bool NewtonInversion::step(double allowed_rise) noexcept {
  std::vector<double>& x = circuit_.x();
  equations_.set_up();
  std::copy(x.begin(), x.end(), last_x_.begin());
  const double before = circuit_.merit();
  const double accuracy = kAccuracy * before / std::sqrt(static_cast<double>(x.size()));
  for (; damping_ <= kMostDamping; damping_ = std::max(kLeastDamping, kDampingFactor * damping_)) {
    equations_.solve(damping_, std::clamp(accuracy, kBestAccuracy, kLeastAccuracy));
    for (std::size_t k = 0; k < x.size(); ++k) change_[k] = equations_.change(k);
    for (double fraction = 1.0; fraction >= kShortestFraction; fraction *= 0.5) {
      for (std::size_t k = 0; k < x.size(); ++k) x[k] = moved(k, last_x_[k], fraction * change_[k]);
      circuit_.solve();
      const double after = circuit_.merit();
      const bool may_go_on = budget_.take(1.0);
      if (!(after < allowed_rise * before)) {
        if (may_go_on) continue;
        damping_ = kMostDamping;
        break;
      }
      damping_ = damping_ > kLeastDamping ? damping_ / kDampingFactor : 0.0;
      return after > kRoundingMerit || after < 0.5 * before;
    }
    std::copy(last_x_.begin(), last_x_.end(), x.begin());
    circuit_.solve();
    if (before < kRoundingMerit) return false;
  }
  return false;
}

void NewtonInversion::propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept {
  equations_.set_up();
  driver_errors_.find_slopes(circuit_, equations_);
  std::fill(sigma_siemens.begin(), sigma_siemens.end(), 0.0);
  noise_->add_to(sigma_siemens, sigma_ratio);
  for (std::size_t k = 0; k < sigma_siemens.size(); ++k) {
    const double sigma = equations_.column_scale()[k] * std::sqrt(sigma_siemens[k]);
    sigma_siemens[k] = sigma < kMostSiemens ? sigma : kMostSiemens;  // also where nothing is known: not a number
  }
}

}  // namespace dermis::touch::compensation
