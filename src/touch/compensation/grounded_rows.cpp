// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/grounded_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/compensation/readout_parts.hpp"
#include "touch/compensation/sensed_line.hpp"
#include "touch/compensation/shorted_crossings.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kMostSteps = 300.0;   // of a frame where steps are bounded
constexpr double kWorkOfLines = 96.0;  // over the lines whose currents a step sums up: what a frame may take on average
constexpr double kStartWork = 1.0;     // before the first step,
constexpr double kKeptWork = 4.0;      // and for a line of kept taxels, with what they take elsewhere
constexpr double kMixedWork = 5.0;     // of a mixed step beside a plain one
constexpr int kPlainSteps = 24;
constexpr double kShrinks = 0.95;  // of the certificate in a step; what shrinks less is left to the mixing
constexpr int kFilmSteps = 4;      // under a film, whose first change may lead uphill
constexpr int kMixedSteps = 400;
constexpr int kDampedSteps = 200;
constexpr int kStepsWithoutGain = 60;
constexpr int kRoundedStepsWithoutGain = 5;
constexpr double kRough = 1e-4;     // certificate, above which single precision shows the way as well
constexpr double kRounded = 1e-12;  // certificate; what is left of it is rounding
constexpr std::size_t kMixingDepth = 8;
constexpr double kMostLogStep = 2.0;

DERMIS_PROCESSOR_CLONES bool any_is_missing(std::span<const double> ratio) {
  const double* const readings = ratio.data();
  std::uint64_t missing = 0;
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) missing |= readings[taxel] != readings[taxel] ? 1 : 0;
  return missing != 0;
}

}  // namespace

GroundedRows::Sources::Sources(std::size_t rows, std::size_t stride)
    : siemens(stride),
      column_ratio(stride),
      last_ratio(stride),
      change(stride),
      mixing(stride, kMixingDepth),
      column_return(stride),
      column_sum(stride),
      line_ratio(rows) {}

GroundedRows::Mixing::Mixing(std::size_t size)
    : anderson(size, kMixingDepth), log_siemens(size), last_log_siemens(size), log_step(size) {}

GroundedRows::GroundedRows(const ArrayDescription& array, double tolerance_ratio, const InversionOptions& options)
    : tolerance_(tolerance_ratio),
      budget_(options.is_bounded ? kMostSteps : 0.0, kWorkOfLines / static_cast<double>(array.cols)),
      state_(array.rows, array.cols, array.readout.idle_columns),
      reading_siemens_(state_.stride),
      offset_siemens_(state_.stride),
      sources_(state_.rows, state_.stride),
      last_estimate_(state_.siemens.size()),
      best_siemens_(state_.siemens.size()),
      best_explained_(state_.siemens.size()),
      mixing_(state_.siemens.size()),
      sigma_column_(state_.stride) {
  state_.kept.reserve(array.taxel_count());
  state_.shorted.reserve(array.cols);
  joined_.rows.reserve(array.rows);
  joined_.cols.reserve(array.cols);
  const Readout& readout = array.readout;
  state_.drive_ohm = joined_.drive_ohm = readout.drive_ohm;
  const double weakest_driver = *std::max_element(state_.drive_ohm.begin(), state_.drive_ohm.end());
  const bool one_loaded = readout.idle_columns == IdleColumns::floating;
  const auto cols = static_cast<std::ptrdiff_t>(array.cols);
  for (std::size_t col = 0; col < array.cols; ++col) {
    const SensedLine sensed = sensed_line(readout, col);
    reading_siemens_[col] = 1.0 / sensed.gain;
    offset_siemens_[col] = -sensed.offset / sensed.gain;
    state_.column_ohm[col] = sensed.rho;
    state_.certificate_ratio[col] = (one_loaded ? 1.0 + weakest_driver / sensed.rho : 1.0) * sensed.gain;
  }
  joined_.column_ohm = state_.column_ohm;
  can_break_ = readout.circuit == Circuit::divider && !readout.film;
  if (options.counts_driver_errors && !is_absent(readout.drive_error_ohm)) {
    driver_error_.emplace(array, std::vector<double>(state_.column_ohm.begin(), state_.column_ohm.begin() + cols));
  }
  if (readout.film) {
    state_.film = std::make_shared<GroundedRowsFilm>(FilmFollower(array, options.references), state_);
  }
  if (is_absent(readout.amplifier_offset_v)) return;
  sources_.ratio.resize(state_.stride);
  for (std::size_t col = 0; col < array.cols; ++col) sources_.ratio[col] = sensed_line(readout, col).emf;
}

double GroundedRows::siemens_per_ratio() const noexcept {
  return *std::max_element(reading_siemens_.begin(), reading_siemens_.end());
}

InversionResult GroundedRows::invert(std::span<const double> ratio, std::span<double> siemens) noexcept {
  std::swap(state_.estimate, last_estimate_);
  load(ratio, siemens);
  const double kept_lines = static_cast<double>(state_.kept.size()) / static_cast<double>(state_.cols);
  budget_.spend(kStartWork + kKeptWork * std::min(kept_lines, 1.0));
  estimate_from_readings(state_);
  if (state_.film) state_.film->precision = first_precision_;
  if (has_last_) {
    if (is_broken_) keep_open_rows();
    start_warm(state_, last_estimate_);
  } else {
    start_cold(state_);
  }
  double certificate = iterate();
  if (!(certificate <= tolerance_)) certificate = iterate_with_mixing(certificate, 0);
  if (!(certificate <= std::max(tolerance_, kRounded))) certificate = iterate_with_mixing(certificate, kDampedSteps);
  const bool solved = certificate <= std::max(tolerance_, kRounded);
  if (solved && !is_broken_ && state_.kept.empty()) budget_.learn();
  is_unfinished_ = !solved && budget_.is_used_up() && certificate <= kMostLeft;
  if (!solved && !is_unfinished_) start_anew();
  has_last_ = solved || is_unfinished_;
  for (std::size_t row = 0; row < state_.rows; ++row) {
    std::copy_n(&state_.siemens[row * state_.stride], state_.cols, &siemens[row * state_.cols]);
  }
  if (is_broken_) split_joined(siemens);
  for (const auto& [row, col, is_second] : state_.shorted) {
    siemens[row * state_.cols + col] = (1.0 / state_.column_part[col] - 1.0) / state_.column_ohm[col];
  }
  if (!solved) {
    std::replace_if(
        siemens.begin(), siemens.end(), [](double value) { return !std::isfinite(value); }, 0.0);
  }
  return {solved, certificate, !solved && budget_.is_used_up()};
}

void GroundedRows::hold_film(const FilmConductances& film) noexcept {
  if (state_.film) state_.film->follower.hold(film);
}

void GroundedRows::forget() noexcept {
  start_anew();
  budget_.forget();
}

void GroundedRows::start_anew() noexcept {
  has_last_ = false;
  is_unfinished_ = false;
  first_precision_ = Precision::full;
  if (state_.film) state_.film->follower.forget();
  std::fill(sources_.siemens.begin(), sources_.siemens.end(), 0.0);
  std::fill(sources_.column_ratio.begin(), sources_.column_ratio.end(), 0.0);
}

/// y of the readings, with what the sources drove into the array in the last frame.
void GroundedRows::load(std::span<const double> ratio, std::span<const double> siemens) noexcept {
  load_readings(ratio);
  state_.kept.clear();
  if (any_is_missing(ratio)) keep_missing(ratio, siemens);
  if (!joined_.rows.empty() || !joined_.cols.empty()) load_joined();
  if (!state_.shorted.empty()) take_loads_away(state_);
}

DERMIS_PROCESSOR_CLONES void GroundedRows::load_readings(std::span<const double> ratio) noexcept {
  const double* const siemens = reading_siemens_.data();
  const double* const offset = offset_siemens_.data();
  const double* const of_sources = sources_.siemens.data();
  for (std::size_t row = 0; row < state_.rows; ++row) {
    const double* const readings = &ratio[row * state_.cols];
    double* const measured = &state_.measured[row * state_.stride];
    for (std::size_t col = 0; col < state_.cols; ++col) {
      measured[col] = siemens[col] * readings[col] + offset[col] + of_sources[col];
    }
  }
}

void GroundedRows::keep_missing(std::span<const double> ratio, std::span<const double> siemens) noexcept {
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    if (std::isnan(ratio[taxel])) state_.kept.push_back({taxel / state_.cols, taxel % state_.cols, siemens[taxel]});
  }
}

double GroundedRows::certify(Precision precision) noexcept {
  const double left = sources_.ratio.empty() ? 0.0 : follow_sources();
  return assess(state_, precision) + left;
}

/// Certificate of the iterate that it ends with.
double GroundedRows::iterate() noexcept {
  double last = std::numeric_limits<double>::infinity();
  Precision precision = first_precision_;
  if (state_.film) state_.film->has_last_step = false;
  for (int step = 0;; ++step) {
    const double certificate = certify(precision);
    const Precision next_precision = certificate > kRough ? Precision::single : Precision::full;
    if (step == 0) first_precision_ = next_precision;
    if (certificate <= tolerance_ && precision == Precision::full) return certificate;
    const bool is_start = state_.film && step < kFilmSteps;
    if (step > 0 && !(certificate < last) && !is_start) break;
    const bool shrinks = certificate <= kShrinks * last || is_start;
    if (step == kPlainSteps || !shrinks || !budget_.take(1.0)) {
      keep();
      return certificate;
    }
    last = certificate;
    precision = next_precision;
    std::swap(state_.siemens, best_siemens_);  // advance() writes both anew
    std::swap(state_.explained, best_explained_);
    if (state_.film) state_.film->precision = precision;
    advance(state_, best_siemens_);
  }
  state_.siemens = best_siemens_;
  state_.explained = best_explained_;
  return last;
}

void GroundedRows::keep() noexcept {
  best_siemens_ = state_.siemens;
  best_explained_ = state_.explained;
}

/// From the start, or where the last frame was cut short. The first steps are halved (below (4) of
/// docs/reasons/derivations-circuits.md), the others mixed.
double GroundedRows::iterate_with_mixing(double best, int damped_steps) noexcept {
  start_mixing(is_unfinished_ ? state_.siemens : state_.estimate, mixing_.log_siemens);
  is_unfinished_ = false;
  mixing_.anderson.forget();
  if (state_.film) state_.film->precision = Precision::full;
  int without_gain = 0;
  for (int step = 0; step < damped_steps + kMixedSteps && best > tolerance_ && budget_.take(kMixedWork); ++step) {
    take_mixed_step(state_, mixing_.log_siemens);
    refresh(state_);
    const double certificate = certify(Precision::full);
    if (certificate < best) {
      best = certificate;
      keep();
      without_gain = 0;
    }
    if (step < damped_steps) {
      mixing_.anderson.forget();
      without_gain = 0;
    }
    if (++without_gain > (best <= kRounded ? kRoundedStepsWithoutGain : kStepsWithoutGain)) break;
    choose_step();
  }
  state_.siemens = best_siemens_;
  state_.explained = best_explained_;
  return best;
}

/// The next ln G.
void GroundedRows::choose_step() noexcept {
  if (!find_log_step(state_, mixing_.log_step)) mixing_.anderson.forget();
  mixing_.last_log_siemens = mixing_.log_siemens;
  mixing_.anderson.advance(mixing_.log_siemens, mixing_.log_step);
  const double least = std::log(kLeastSiemens);
  for (std::size_t k = 0; k < mixing_.log_siemens.size(); ++k) {
    const double last = mixing_.last_log_siemens[k];
    const double next = std::clamp(mixing_.log_siemens[k], last - kMostLogStep, last + kMostLogStep);
    mixing_.log_siemens[k] = std::max(next, least);
  }
}

/// Takes the first order of the circuit's equations about the solution, d(S D^-1 y) = d(G diag(w)). The term that
/// couples a taxel to those of other rows and columns at once is left out:
///
///   dG_ij = base_ij + Rd_i G_ij sum_j' base_ij' + RL_j G_ij sum_i' base_i'j,   base_ij = (S D^-1)_ii dy_ij / w_j
///
/// Compared with the exact Jacobian it is at most 5 % too large, with one load 8 %. That is for 16x16 taxels of 1-100
/// kohm, drivers up to 50 ohm, and loads of 100 ohm to 1 kohm. Near a fold of the circuit (see the class) up to three
/// times too small.
void GroundedRows::propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept {
  for (std::size_t col = 0; col < state_.cols; ++col) {
    sigma_column_[col] = state_.column_ohm[col] == kOpenOhm ? 0.0 : sigma_ratio * reading_siemens_[col];
  }
  spread_noise(state_, sigma_column_, sigma_siemens);
  if (is_broken_) spread_to_kept(sigma_ratio, sigma_siemens);
  if (!driver_error_) return;
  std::span<const double> between_rows;
  if (state_.film) between_rows = state_.film->follower.film().between_rows;
  driver_error_->add(state_.siemens, state_.explained, state_.stride, between_rows, sigma_siemens);
}

}  // namespace dermis::touch::compensation
