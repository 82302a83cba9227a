// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/compensation/crosstalk.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "touch/compensation/backed_inversion.hpp"
#include "touch/compensation/fault_inversion.hpp"
#include "touch/compensation/grounded_rows.hpp"
#include "touch/compensation/newton_inversion.hpp"
#include "touch/compensation/possible_readings.hpp"
#include "touch/compensation/proportional.hpp"
#include "touch/compensation/readout_parts.hpp"
#include "touch/compensation/sagging_supply.hpp"
#include "touch/compensation/shared_errors.hpp"
#include "touch/compensation/spikes.hpp"
#include "touch/compensation/step_budget.hpp"
#include "touch/compensation/supply_error.hpp"
#include "touch/compensation/transposed.hpp"
#include "touch/compensation/virtual_ground.hpp"

namespace dermis::touch::compensation {

namespace {

constexpr double kToleranceCounts = 0.01;
constexpr int kMostAttempts = 3;
constexpr double kFirstShare = 0.6;             // of the work of a frame: of its first attempt
constexpr int kTrial = 64;                      // of so many frames one begins with all readings again
constexpr double kGoodEnoughSigmas = 0.3;       // of a reading: where the steps of a frame are used up
constexpr double kFaultToleranceCounts = 0.05;  // around an inversion that is right to kToleranceCounts

using Inversion = Result<std::unique_ptr<CrosstalkInversion>>;

template <typename Kind, typename... Arguments>
Inversion inversion(const Arguments&... arguments) {
  return std::unique_ptr<CrosstalkInversion>(std::make_unique<Kind>(arguments...));
}

/// [cols, rows] of [rows, cols]; empty stays empty.
std::vector<double> exchange(std::span<const double> values, const ArrayDescription& array) {
  std::vector<double> exchanged(values.size());
  for (std::size_t taxel = 0; taxel < values.size(); ++taxel) {
    exchanged[taxel % array.cols * array.rows + taxel / array.cols] = values[taxel];
  }
  return exchanged;
}

/// One column driven, the others grounded, one row sensed: the divider with one load, rows and columns exchanged.
Inversion flexitac(const ArrayDescription& array, double tolerance, const InversionOptions& options) {
  ArrayDescription exchanged = array;
  std::swap(exchanged.rows, exchanged.cols);
  exchanged.readout.circuit = Circuit::divider;
  exchanged.readout.idle_columns = IdleColumns::floating;
  const std::vector<double> typical = exchange(options.references.typical, array);
  const std::vector<double> unloaded = exchange(options.references.unloaded, array);
  InversionOptions of_exchanged = options;
  of_exchanged.references = {typical, unloaded, options.references.loads};
  auto rows_driven = std::make_unique<GroundedRows>(exchanged, tolerance, of_exchanged);
  return std::unique_ptr<CrosstalkInversion>(
      std::make_unique<Transposed>(std::move(rows_driven), array.rows, array.cols));
}

/// Most readings that came are invalid now, so nothing can be said about the others.
bool are_most_taken(const std::vector<TaxelStatus>& came, const std::vector<TaxelStatus>& left) {
  const auto before = std::count(came.begin(), came.end(), TaxelStatus::invalid);
  const auto after = std::count(left.begin(), left.end(), TaxelStatus::invalid);
  return 2 * (after - before) > std::ssize(came) - before;
}

Inversion newton(const ArrayDescription& array, double tolerance, const InversionOptions& options) {
  auto model = CircuitModel::create(array);
  if (!model) return model.error();
  return std::unique_ptr<CrosstalkInversion>(
      std::make_unique<NewtonInversion>(array, std::move(*model), tolerance, options));
}

/// The noise of a conductance is mostly that of its own reading.
void follow_slopes(const std::vector<float>& noise_gain, std::vector<double>& sigma_siemens) {
  for (std::size_t taxel = 0; taxel < noise_gain.size(); ++taxel) {
    sigma_siemens[taxel] *= static_cast<double>(noise_gain[taxel]);
  }
}

/// The root mean square over all taxels: a sum does not distinguish them.
double mean_noise_gain(const std::vector<float>& noise_gain) {
  if (noise_gain.empty()) return 1.0;
  double sum = 0.0;
  for (const float gain : noise_gain) sum += static_cast<double>(gain) * static_cast<double>(gain);
  return std::sqrt(sum / static_cast<double>(noise_gain.size()));
}

bool is_invalid(TaxelStatus taxel) {
  return taxel == TaxelStatus::invalid;
}

/// Few frames of one loaded line at a time are beyond the quick inversion under a film. Those are of unloaded sheets
/// whose film conducts more than their taxels, and of taxels far below the resistance of their drivers.
Inversion backed(Inversion quick, const ArrayDescription& array, double tolerance, const InversionOptions& options) {
  Inversion thorough = newton(array, tolerance, options);
  if (!thorough) return thorough.error();
  return std::unique_ptr<CrosstalkInversion>(
      std::make_unique<BackedInversion>(std::move(*quick), std::move(*thorough), array.taxel_count()));
}

Inversion sagging_supply(const ArrayDescription& array, double tolerance, const InversionOptions& options) {
  auto model = CircuitModel::create(array);
  if (!model) return model.error();
  ArrayDescription with_ideal_supply = array;
  with_ideal_supply.readout.supply_ohm.reset();
  Inversion ideal = make_crosstalk_inversion(with_ideal_supply, options);
  if (!ideal) return ideal.error();
  return std::unique_ptr<CrosstalkInversion>(std::make_unique<SaggingSupply>(
      std::move(*ideal), std::move(*model), FilmFollower(array, options.references), tolerance));
}

}  // namespace

Inversion make_crosstalk_inversion(const ArrayDescription& described, const InversionOptions& options) {
  const ArrayDescription array = with_supply_in_drivers(described);
  const Readout& readout = array.readout;
  if (array.has_unknown_circuit()) {
    return bad_input("readout: the circuit or some of its resistances are to be fitted: calibrate the array first");
  }
  const double tolerance = options.tolerance_ratio.value_or(kToleranceCounts / readout.full_scale_counts());
  if (readout.circuit == Circuit::none) return inversion<Proportional>();
  if (readout.supply_ohm.value_or(0.0) > 0.0) return sagging_supply(array, tolerance, options);
  if (has_resistive_lines(readout)) return newton(array, tolerance, options);
  if (readout.circuit == Circuit::flexitac) {
    Inversion quick = flexitac(array, tolerance, options);
    return readout.film ? backed(std::move(quick), array, tolerance, options) : std::move(quick);
  }
  if (readout.circuit == Circuit::transimpedance && has_ideal_amplifiers(readout) && !readout.film) {
    return inversion<VirtualGround>(array, options.counts_driver_errors);
  }
  if (readout.idle_rows == IdleRows::floating) return newton(array, tolerance, options);
  Inversion quick = inversion<GroundedRows>(array, tolerance, options);
  const bool is_backed = readout.film && readout.idle_columns == IdleColumns::floating;
  return is_backed ? backed(std::move(quick), array, tolerance, options) : std::move(quick);
}

Result<Compensator> Compensator::create(const ArrayDescription& described, const ReferenceConductances& references) {
  const ArrayDescription array = with_supply_in_drivers(described);
  InversionOptions options;
  options.counts_driver_errors = true;
  options.is_bounded = true;
  options.references = references;
  Inversion inversion = make_crosstalk_inversion(array, options);
  if (!inversion) return inversion.error();
  return Compensator(array, std::move(*inversion), references);
}

Compensator::Compensator(const ArrayDescription& array, std::unique_ptr<CrosstalkInversion> inversion,
                         const ReferenceConductances& references)
    : inversion_(std::move(inversion)),
      possible_(std::make_unique<PossibleReadings>(array)),
      spikes_(std::make_unique<Spikes>(array)),
      supply_error_(std::make_unique<SupplyError>(array)),
      shared_errors_(std::make_shared<const SharedErrors>(array)),
      faults_(std::make_unique<FaultInversion>(array, kFaultToleranceCounts / array.readout.full_scale_counts(),
                                               references)) {}
Compensator::Compensator(Compensator&&) noexcept = default;
Compensator& Compensator::operator=(Compensator&&) noexcept = default;
Compensator::~Compensator() = default;

void Compensator::set_faults(std::span<const LineFault> faults) {
  faults_->set_faults(faults, *inversion_);
  possible_->set_shorted(faults_->shorted_crossings());
  solving_attempt_ = 0;
}

void Compensator::hold_film(const FilmConductances& film) noexcept {
  inversion_->hold_film(film);
  faults_->hold_film(film);
}

void Compensator::forget() noexcept {
  inversion_->forget();
  possible_->forget();
  spikes_->forget();
  faults_->forget();
  solving_attempt_ = 0;
}

namespace {

void begin_frame(const ConditionedFrame& conditioned, ConductanceFrame& conductance) noexcept {
  conductance.time = conditioned.time;
  conductance.status = conditioned.status;
  conductance.temperature_celsius = conditioned.temperature_celsius;
  conductance.taxel_celsius = conditioned.taxel_celsius;
  conductance.taxels = conditioned.taxels;
  conductance.siemens.resize(conditioned.ratio.size());
  conductance.sigma_siemens.resize(conditioned.ratio.size());
  conductance.residual_sigma = 0.0;
  std::fill(conductance.siemens.begin(), conductance.siemens.end(), 0.0);
}

}  // namespace

void Compensator::process(const ConditionedFrame& conditioned, ConductanceFrame& conductance) noexcept {
  begin_frame(conditioned, conductance);
  prepare_errors(conditioned.ratio.size(), conductance.errors);
  conductance.errors.shared_noise = conditioned.shared_noise;
  if (has(conditioned.status, FrameStatus::rejected)) {
    std::fill(conductance.sigma_siemens.begin(), conductance.sigma_siemens.end(), 0.0);
    return;
  }
  faults_->start_frame(conditioned.time);
  const InversionResult result = invert_possible(conditioned, conductance);
  const bool is_rough = result.solved && result.cut_short;
  if (is_rough || spikes_->any_doubt()) conductance.status |= FrameStatus::doubtful;
  conductance.residual_sigma = result.residual_ratio / conditioned.sigma_ratio;
  if (result.solved) {
    const double left = is_rough ? result.residual_ratio : 0.0;
    const double sigma_ratio = std::hypot(conditioned.sigma_ratio, left);
    inversion_->propagate_noise(sigma_ratio, conductance.sigma_siemens);
    follow_slopes(conditioned.noise_gain, conductance.sigma_siemens);
    note_errors(conditioned, sigma_ratio, conductance);
    shared_errors_->share_noise(conductance.errors, conductance.sigma_siemens);
    if (faults_->any_doubt() || spikes_->any_doubt()) {
      faults_->add_doubt(conductance.errors.doubt_siemens, conductance.siemens, conductance.sigma_siemens);
    }
  } else {
    std::fill(conductance.sigma_siemens.begin(), conductance.sigma_siemens.end(), 0.0);
  }
  supply_error_->add(conductance.siemens, conditioned.supply_doubt, conductance.sigma_siemens);
  if (result.solved) {
    faults_->remember(conductance.siemens);
  } else {
    conductance.status |= FrameStatus::not_converged;
    std::fill(conductance.taxels.begin(), conductance.taxels.end(), TaxelStatus::invalid);
  }
  if (faults_->any()) mask_faulty_taxels(conductance);
  spikes_->remember(conditioned, conductance);
}

/// Without the readings that no conductances explain, and spikes. As long as there is no solution, without the largest
/// of lines that have little left of the supply, then without these lines. Where work is scarce, the attempt that has
/// solved the last frame is the first.
InversionResult Compensator::invert_possible(const ConditionedFrame& conditioned,
                                             ConductanceFrame& conductance) noexcept {
  if (faults_->keeps_bounds()) {
    possible_->check(conditioned.ratio, conditioned.sigma_ratio, conductance.taxels);
  } else {
    possible_->forget();
    spikes_->forget();
  }
  InversionResult result;
  const bool is_plenty = inversion_->start_frame(conditioned.time);
  const bool begins_anew = is_plenty || ++frames_begun_ % kTrial == 0;
  int number = 0;
  for (; number < kMostAttempts && !result.solved; ++number) {
    if (number == 1 && !possible_->take_largest(conditioned.ratio, conductance.taxels)) break;
    if (number == 2 && !possible_->take_full_lines(conditioned.ratio, conductance.taxels)) break;
    if (are_most_taken(conditioned.taxels, conductance.taxels)) break;
    if (number < solving_attempt_ && !begins_anew) continue;
    if (number > solving_attempt_ && !is_plenty) break;
    result = attempt(conditioned, conductance, number == 0);
  }
  solving_attempt_ = result.solved ? number - 1 : (solving_attempt_ + 1) % kMostAttempts;
  if (std::all_of(conductance.taxels.begin(), conductance.taxels.end(), is_invalid)) result.solved = false;
  return result;
}

/// A frame that is cut short near its solution keeps all of its readings.
InversionResult Compensator::attempt(const ConditionedFrame& conditioned, ConductanceFrame& conductance,
                                     bool is_first) noexcept {
  inversion_->start_attempt(is_first ? kFirstShare : 1.0);
  InversionResult result = invert(conditioned, conductance);
  if (is_first && spikes_->take(conditioned, result.solved, conductance)) {
    inversion_->start_attempt(kFirstShare);
    result = invert(conditioned, conductance);
  }
  result.solved = result.solved || (result.cut_short && result.residual_ratio <= kMostLeft);
  return result;
}

InversionResult Compensator::invert(const ConditionedFrame& conditioned, ConductanceFrame& conductance) noexcept {
  InversionResult result = faults_->concerns(conductance.taxels)
                               ? faults_->invert(*inversion_, conditioned.ratio, conductance.siemens)
                               : inversion_->invert(conditioned.ratio, conductance.siemens);
  if (!result.solved && result.residual_ratio <= kGoodEnoughSigmas * conditioned.sigma_ratio) {
    result = {true, result.residual_ratio};
  }
  return result;
}

/// A first frame without a solution has their size, too.
void Compensator::prepare_errors(std::size_t taxels, ConductanceErrors& errors) const noexcept {
  errors.siemens.resize(taxels);
  errors.noise_siemens.resize(shared_errors_->tells_noise() ? 0 : taxels);
  errors.doubt_siemens.resize(taxels);
  if (errors.circuit != shared_errors_) errors.circuit = shared_errors_;
}

/// Before anything but noise is in the standard deviations.
void Compensator::note_errors(const ConditionedFrame& conditioned, double sigma_ratio,
                              ConductanceFrame& conductance) const noexcept {
  ConductanceErrors& errors = conductance.errors;
  errors.siemens.assign(conductance.siemens.begin(), conductance.siemens.end());
  if (!shared_errors_->tells_noise()) {
    errors.noise_siemens.assign(conductance.sigma_siemens.begin(), conductance.sigma_siemens.end());
  }
  faults_->find_doubt(conductance.siemens, errors.doubt_siemens);
  spikes_->add_doubt(errors.doubt_siemens);
  errors.sigma_ratio = sigma_ratio * mean_noise_gain(conditioned.noise_gain);
  errors.supply_doubt = conditioned.supply_doubt;
}

void Compensator::mask_faulty_taxels(ConductanceFrame& conductance) const noexcept {
  conductance.status |= FrameStatus::line_fault;
  for (std::size_t taxel = 0; taxel < conductance.taxels.size(); ++taxel) {
    if (faults_->is_masked(taxel)) conductance.taxels[taxel] = TaxelStatus::line_fault;
  }
}

}  // namespace dermis::touch::compensation
