// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/fusion/force_fusion.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/fusion/force_kernels.hpp"

namespace dermis::touch::fusion {
namespace {

constexpr float kNoForce = std::numeric_limits<float>::quiet_NaN();
constexpr float kNoUpperBound = std::numeric_limits<float>::infinity();
constexpr double kUnlearnedPerCelsius = 0.005;  // 1/C, standard deviation of the temperature coefficient of rubber
constexpr float kCommonSigmas = 2.0F;           // of an error that all taxels share

// Beyond the heaviest calibrated load the exponent stays as it is there. It is uncertain by the first, and changes by
// the second for every factor e of the force. docs/reasons/derivations-forces.md, "Beyond the calibrated loads".
constexpr float kExponentSigma = 0.2F;
constexpr float kExponentChange = 0.3F;
constexpr float kLineExponentSigma = 0.3F;  // below the first load of a table: a line, where rubber has a power
constexpr float kMostStretch = 8.0F;        // times the heaviest load: beyond, only that it is more is known

template <typename Values, typename Predicate>
bool all(const Values& values, std::size_t size, Predicate predicate) {
  return values.size() == size && std::all_of(values.begin(), values.end(), predicate);
}

/// The weights that make the force rise with conductance are not negative.
bool rises_with_conductance(const network::PerceptronShape& shape, const std::vector<float>& parameters,
                            std::size_t taxels) {
  if (shape.rising_inputs + 1 != kInputsWithTemperature) return false;
  for (std::size_t k = 0; k < shape.parameter_count(); ++k) {
    if (!network::monotone::is_positive(shape, k)) continue;
    const auto first = parameters.begin() + static_cast<std::ptrdiff_t>(k * taxels);
    if (std::any_of(first, first + static_cast<std::ptrdiff_t>(taxels), [](float weight) { return weight < 0.0F; })) {
      return false;
    }
  }
  return true;
}

void resize(ForceSums& sums, std::size_t taxels) {
  sums.newtons.resize(taxels);
  sums.own_variance.resize(taxels);
  sums.newtons_per_siemens.resize(taxels);
  sums.newtons_per_celsius.resize(taxels);
}

/// Relative error of a force that is exp(stretch) times that at the end of its law. The exponent changes on by `bend`
/// for every factor e of the true force. Straight from where such a law hardly answers any more.
float bend_error(float bend, float stretch) {
  if (!(bend > 0.0F && stretch > 0.0F)) return 0.0F;
  constexpr float kAnswered = 0.95F;
  const float known = std::min(stretch, kAnswered / bend);
  return std::expm1(-std::log1p(-bend * known) / bend - known) * stretch / known;
}

/// The taxel counts in sums as it does alone.
void count_alone(std::size_t taxel, ForceFrame& force) {
  const float sigma = force.sigma_newtons[taxel];
  force.sums.newtons[taxel] = force.newtons[taxel];
  force.sums.own_variance[taxel] = sigma * sigma;
  force.sums.newtons_per_siemens[taxel] = 0.0F;
  force.sums.newtons_per_celsius[taxel] = 0.0F;
}

}  // namespace

bool ForceNetworks::is_consistent() const noexcept {
  const auto is_finite = [](auto value) { return std::isfinite(value); };
  const auto is_positive = [](auto value) { return std::isfinite(value) && value > 0; };
  const auto is_not_negative = [](auto value) { return std::isfinite(value) && value >= 0; };
  const std::size_t taxels = taxel_count();
  const bool uses_temperature = shape.inputs == kInputsWithTemperature;
  const auto& [centre_celsius, half_span_celsius] = unloaded.temperature;
  const bool in_range = (uses_temperature || shape.inputs + 1 == kInputsWithTemperature) && shape.hidden <= 64 &&
                        std::isfinite(centre_celsius) && std::isfinite(half_span_celsius) &&
                        half_span_celsius >= 0.0 &&  // std::clamp needs low <= high
                        (!uses_temperature || half_span_celsius > 0.0) &&
                        std::all_of(temperature_gap_celsius.begin(), temperature_gap_celsius.end(), is_finite) &&
                        temperature_gap_celsius[0] <= temperature_gap_celsius[1];
  return in_range && all(unloaded.offset_siemens, taxels, is_finite) && all(unloaded.per_celsius, taxels, is_finite) &&
         all(reference_siemens, taxels, is_positive) && all(heaviest_siemens, taxels, is_positive) &&
         all(heaviest_newtons, taxels, [](float value) { return value > 0.0F; }) && all(gain, taxels, is_positive) &&
         all(dead, taxels, [](std::uint8_t value) { return value <= 1; }) &&
         all(parameters, shape.parameter_count() * taxels, is_finite) && std::isfinite(temperature_sigma_celsius) &&
         temperature_sigma_celsius >= 0.0 && all(offset_sigma_siemens, taxels, is_not_negative) &&
         all(relative_sigma, kSigmaKnots * taxels, is_positive) &&
         std::all_of(sigma_knots_newtons.begin(), sigma_knots_newtons.end(), is_positive) &&
         sigma_knots_newtons[0] < sigma_knots_newtons[1] && gain_errors.is_consistent(taxels) &&
         std::all_of(end_bends.begin(), end_bends.end(), is_not_negative) && tables.is_consistent(taxels) &&
         rises_with_conductance(shape, parameters, taxels);
}

float ForceNetworks::sigma_place(float log_newtons) const noexcept {
  const float first = std::log(sigma_knots_newtons[0]);
  const float last = std::log(sigma_knots_newtons[1]);
  constexpr auto kLastKnot = static_cast<float>(kSigmaKnots - 1);
  return std::clamp(kLastKnot * (log_newtons - first) / (last - first), 0.0F, kLastKnot);
}

ForceFusion::ForceFusion(ForceNetworks networks)
    : networks_(std::move(networks)),
      gain_errors_(networks_.gain_errors.sigma.empty() ? nullptr
                                                       : std::make_shared<const GainErrors>(networks_.gain_errors)),
      bank_(networks_.shape, networks_.taxel_count(), networks_.parameters),
      temperatures_{{},
                    std::vector<double>(networks_.taxel_count()),
                    std::vector<float>(networks_.taxel_count()),
                    std::vector<float>(networks_.taxel_count())},
      offset_per_celsius_(networks_.unloaded.per_celsius.begin(), networks_.unloaded.per_celsius.end()),
      excess_siemens_(networks_.taxel_count()),
      sigma_siemens_(networks_.taxel_count()),
      inputs_(networks_.shape.inputs * networks_.taxel_count()),
      outputs_(networks_.taxel_count()),
      gradient_(inputs_.size()),
      table_variance_(networks_.taxel_count()),
      noise_newtons_(networks_.taxel_count()) {
  assert(networks_.is_consistent());
  for (const float siemens : networks_.reference_siemens) per_reference_siemens_.push_back(1.0F / siemens);
  for (const float gain : networks_.gain) log_gain_.push_back(std::log(gain));
  for (std::size_t k = 0; k < networks_.relative_sigma.size(); ++k) {
    const float sigma = networks_.relative_sigma[k];
    const float before = k < networks_.taxel_count() ? 0.0F : networks_.relative_sigma[k - networks_.taxel_count()];
    variance_rises_.push_back(sigma * sigma - before * before);
  }
  for (std::size_t table = 0; table < networks_.tables.taxels.size(); ++table) {
    line_end_siemens_.push_back(networks_.tables.line_end_siemens(table));
  }
}

void ForceFusion::process(const ConductanceFrame& conductance, ForceFrame& force) noexcept {
  const std::size_t taxels = networks_.taxel_count();
  force.time = conductance.time;
  force.status = conductance.status;
  force.taxels = conductance.taxels;
  force.newtons.resize(taxels);
  force.sigma_newtons.resize(taxels);
  force.signal_to_noise.resize(taxels);
  resize(force.sums, taxels);
  force.sums.conductances = conductance.errors;
  if (!conductance.errors.circuit) {
    force.sums.conductances.noise_siemens.assign(conductance.sigma_siemens.begin(), conductance.sigma_siemens.end());
  }
  const bool fits = conductance.siemens.size() == taxels && conductance.sigma_siemens.size() == taxels;
  if (has(conductance.status, FrameStatus::rejected) || !fits) {
    force.status |= FrameStatus::rejected;
    force.taxels.assign(taxels, TaxelStatus::invalid);
    std::fill(force.newtons.begin(), force.newtons.end(), kNoForce);
    std::fill(force.sigma_newtons.begin(), force.sigma_newtons.end(), kNoForce);
    std::fill(force.signal_to_noise.begin(), force.signal_to_noise.end(), kNoForce);
    std::fill(force.sums.newtons.begin(), force.sums.newtons.end(), kNoForce);
    return;
  }
  find_temperatures(conductance, force);
  prepare_inputs(conductance);
  bank_.evaluate(inputs_, outputs_, gradient_);
  look_up();
  compute_forces(force);
  compute_signals(force);
  apply_status(force);
}

void ForceFusion::find_temperatures(const ConductanceFrame& conductance, ForceFrame& force) noexcept {
  const std::size_t taxels = networks_.taxel_count();
  temperatures_.of_array = temperature(conductance.temperature_celsius, force);
  std::fill(temperatures_.offset.begin(), temperatures_.offset.end(), temperatures_.of_array.offset);
  std::fill(temperatures_.sigma.begin(), temperatures_.sigma.end(), static_cast<float>(temperatures_.of_array.sigma));
  std::fill(temperatures_.gain_variance.begin(), temperatures_.gain_variance.end(),
            temperatures_.of_array.unlearned_variance());
  if (conductance.taxel_celsius.size() == taxels) find_own_temperatures(conductance, force);
  if (!gain_errors_) return;
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    temperatures_.gain_variance[taxel] += gain_errors_->sigma[taxel] * gain_errors_->sigma[taxel];
  }
}

void ForceFusion::find_own_temperatures(const ConductanceFrame& conductance, ForceFrame& force) noexcept {
  const std::size_t taxels = networks_.taxel_count();
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const Temperature own = temperature(conductance.celsius(taxel), force);
    temperatures_.offset[taxel] = own.offset;
    temperatures_.sigma[taxel] = static_cast<float>(own.sigma);
    temperatures_.gain_variance[taxel] = own.unlearned_variance();
    temperatures_.of_array.sigma = std::max(temperatures_.of_array.sigma, own.sigma);
    temperatures_.of_array.outside = std::max(std::abs(temperatures_.of_array.outside), std::abs(own.outside));
  }
}

float ForceFusion::Temperature::unlearned_variance() const noexcept {
  return static_cast<float>(std::pow(kUnlearnedPerCelsius * outside, 2));
}

ForceFusion::Temperature ForceFusion::temperature(std::optional<double> measured, ForceFrame& force) const noexcept {
  const TemperatureSpan& calibrated = networks_.unloaded.temperature;
  if (!measured) {
    if (uses_temperature()) force.status |= FrameStatus::temperature_unknown;
    return {0.0, calibrated.half_span_celsius / std::numbers::sqrt3, 0.0};  // anywhere in the calibrated span
  }
  const double celsius = *measured;
  const double offset = celsius - calibrated.centre_celsius;
  const double clamped = calibrated.offset(celsius);
  const bool is_known = calibrated.half_span_celsius > 0.0;  // at which temperatures the forces were calibrated
  const double outside = is_known ? std::abs(offset - clamped) : 0.0;
  constexpr double kSensorNoiseCelsius = 1.0;
  if (uses_temperature() && outside > kSensorNoiseCelsius) force.status |= FrameStatus::temperature_clamped;
  const auto& [lowest, highest] = networks_.temperature_gap_celsius;
  const double in_gap = std::max(std::min(celsius - lowest, highest - celsius), 0.0);
  return {clamped, std::hypot(networks_.temperature_sigma_celsius, outside, in_gap), outside};
}

DERMIS_PROCESSOR_CLONES void ForceFusion::prepare_inputs(const ConductanceFrame& conductance) noexcept {
  const std::size_t taxels = networks_.taxel_count();
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const double unloaded = networks_.unloaded.at(taxel, temperatures_.offset[taxel]);
    excess_siemens_[taxel] = static_cast<float>(conductance.siemens[taxel] - unloaded);
    const auto noise = static_cast<float>(conductance.sigma_siemens[taxel]);
    const float offset_sigma = networks_.offset_sigma_siemens[taxel];
    sigma_siemens_[taxel] = std::sqrt(noise * noise + offset_sigma * offset_sigma);
  }
  conductance_inputs({networks_.reference_siemens, per_reference_siemens_, networks_.heaviest_siemens, excess_siemens_,
                      sigma_siemens_},
                     std::span(inputs_).first(2 * taxels));
  if (!uses_temperature()) return;
  const double half_span = networks_.unloaded.temperature.half_span_celsius;
  std::transform(temperatures_.offset.begin(), temperatures_.offset.end(),
                 inputs_.begin() + static_cast<std::ptrdiff_t>(2 * taxels),
                 [half_span](double offset) { return static_cast<float>(offset / half_span); });
}

/// In the place of the networks, where there are tables.
void ForceFusion::look_up() noexcept {
  const std::size_t taxels = networks_.taxel_count();
  const ForceTables& tables = networks_.tables;
  for (std::size_t table = 0; table < tables.taxels.size(); ++table) {
    const std::size_t taxel = tables.taxels[table];
    const float asked = networks_.reference_siemens[taxel] * std::exp(inputs_[taxel]);
    const ForceTables::Value value = tables.at(table, asked, static_cast<float>(temperatures_.offset[taxel]));
    outputs_[taxel] = value.log_newtons - log_gain_[taxel];
    const bool is_beyond = excess_siemens_[taxel] > networks_.heaviest_siemens[taxel];
    gradient_[taxel] = is_beyond ? tables.end_exponent(table) : value.exponent;
    gradient_[taxels + taxel] = 0.0F;
    // Where the standard deviation is taken: at one of the conductance at least.
    const float reached = std::max(asked, sigma_siemens_[taxel]);
    const float below = std::log(std::max(line_end_siemens_[table] / reached, 1.0F));
    table_variance_[taxel] = kLineExponentSigma * kLineExponentSigma * below * below;
    if (!uses_temperature()) continue;
    const double half_span = networks_.unloaded.temperature.half_span_celsius;
    gradient_[2 * taxels + taxel] = value.per_celsius * static_cast<float>(half_span);
  }
}

void ForceFusion::compute_forces(ForceFrame& force) noexcept {
  const float first = std::log(networks_.sigma_knots_newtons[0]);
  const float last = std::log(networks_.sigma_knots_newtons[1]);
  ForceSources sources;
  sources.excess = {networks_.reference_siemens, per_reference_siemens_, networks_.heaviest_siemens, excess_siemens_,
                    sigma_siemens_};
  sources.log_gain = log_gain_;
  sources.inputs = inputs_;
  sources.log_newtons = outputs_;
  sources.gradient = gradient_;
  sources.offset_per_celsius = offset_per_celsius_;
  sources.offset_sigma = networks_.offset_sigma_siemens;
  sources.variance_rises = variance_rises_;
  sources.table_variance = table_variance_;
  sources.temperature_sigma = temperatures_.sigma;
  if (uses_temperature()) {
    sources.temperature_per_celsius = static_cast<float>(1.0 / networks_.unloaded.temperature.half_span_celsius);
  }
  sources.gain_variance = temperatures_.gain_variance;
  sources.log_first_knot = first;
  sources.bend_below = networks_.end_bends[0];
  sources.knots_per_log = static_cast<float>(kSigmaKnots - 1) / (last - first);
  ForceSums& sums = force.sums;
  forces(sources, {force.newtons, force.sigma_newtons, noise_newtons_, sums.newtons, sums.own_variance,
                   sums.newtons_per_siemens, sums.newtons_per_celsius});
  sums.temperature_sigma = temperatures_.of_array.sigma;
  sums.gains = gain_errors_;
  sums.gain_sigma = std::sqrt(static_cast<double>(temperatures_.of_array.unlearned_variance()));
}

DERMIS_PROCESSOR_CLONES void ForceFusion::compute_signals(ForceFrame& force) const noexcept {
  for (std::size_t taxel = 0; taxel < networks_.taxel_count(); ++taxel) {
    const float noise =
        sigma_siemens_[taxel] + kCommonSigmas * temperatures_.sigma[taxel] * std::abs(offset_per_celsius_[taxel]);
    force.signal_to_noise[taxel] = excess_siemens_[taxel] / std::max(noise, std::numeric_limits<float>::min());
  }
}

/// Most taxels have nothing to say but newtons: those that have are looked for in blocks.
void ForceFusion::apply_status(ForceFrame& force) const noexcept {
  constexpr std::size_t kBlock = 64;
  const std::size_t taxels = networks_.taxel_count();
  for (std::size_t from = 0; from < taxels; from += kBlock) {
    const std::size_t to = std::min(from + kBlock, taxels);
    if (are_plain(from, to, force)) continue;
    for (std::size_t taxel = from; taxel < to; ++taxel) {
      if (apply_status(taxel, force)) count_alone(taxel, force);
    }
  }
}

DERMIS_PROCESSOR_CLONES bool ForceFusion::are_plain(std::size_t from, std::size_t to,
                                                    const ForceFrame& force) const noexcept {
  const float* const excess = excess_siemens_.data();
  const float* const most_siemens = networks_.heaviest_siemens.data();
  const float* const most_newtons = networks_.heaviest_newtons.data();
  const float* const newtons = force.newtons.data();
  const std::uint8_t* const dead = networks_.dead.data();
  const TaxelStatus* const status = force.taxels.data();
  int beyond = 0;
  std::uint8_t marked = 0;
  for (std::size_t taxel = from; taxel < to; ++taxel) {
    beyond |= excess[taxel] <= most_siemens[taxel] ? 0 : 1;  // nor where there is no excess
    beyond |= newtons[taxel] > most_newtons[taxel] ? 1 : 0;
  }
  for (std::size_t taxel = from; taxel < to; ++taxel) {
    marked = static_cast<std::uint8_t>(marked | dead[taxel] | static_cast<std::uint8_t>(status[taxel]));
  }
  static_assert(TaxelStatus::ok == TaxelStatus{});
  return beyond == 0 && marked == 0;
}

/// Whether it changed the force or its standard deviation.
bool ForceFusion::apply_status(std::size_t taxel, ForceFrame& force) const noexcept {
  TaxelStatus& status = force.taxels[taxel];
  float& newtons = force.newtons[taxel];
  float& sigma = force.sigma_newtons[taxel];
  if (networks_.dead[taxel] != 0) {
    status = TaxelStatus::dead;
    force.status |= FrameStatus::dead_taxels;
  } else if (std::isnan(excess_siemens_[taxel])) {
    status = TaxelStatus::invalid;
  }
  if (status == TaxelStatus::dead || status == TaxelStatus::invalid || status == TaxelStatus::line_fault) {
    newtons = kNoForce;
    sigma = kNoForce;
    force.signal_to_noise[taxel] = kNoForce;
    return true;
  }
  const bool is_saturated = status == TaxelStatus::saturated;
  if (is_saturated) {
    sigma = kNoUpperBound;
    force.signal_to_noise[taxel] = kNoUpperBound;
  }
  if (excess_siemens_[taxel] <= networks_.heaviest_siemens[taxel] && newtons <= networks_.heaviest_newtons[taxel]) {
    return is_saturated;
  }
  force.status |= FrameStatus::above_range;
  if (is_saturated) {
    newtons = std::min(newtons, networks_.heaviest_newtons[taxel]);  // the force is at least the one given
    return true;
  }
  if (status == TaxelStatus::ok) status = TaxelStatus::above_range;
  extrapolate(taxel, newtons, sigma);
  return true;
}

/// From the force and standard deviation at the end of what was calibrated, along the law that holds there.
void ForceFusion::extrapolate(std::size_t taxel, float& newtons, float& sigma) const noexcept {
  const float heaviest_siemens = networks_.heaviest_siemens[taxel];
  const float of_share = gradient_[networks_.taxel_count() + taxel] / networks_.reference_siemens[taxel];
  const float exponent = gradient_[taxel] + of_share * std::min(excess_siemens_[taxel], heaviest_siemens);
  const float at_end = newtons;
  const float known = std::min(at_end, networks_.heaviest_newtons[taxel]);
  newtons *= std::pow(std::max(excess_siemens_[taxel] / heaviest_siemens, 1.0F), exponent);
  if (!(newtons < kMostStretch * known)) {
    newtons = kMostStretch * known;
    sigma = kNoUpperBound;
    return;
  }
  // Calibrations cover what is used: a little more than the heaviest load is believed as far as it stands out of the
  // noise.
  const float excess = std::log(newtons / known);
  const float noise = sigma / at_end;
  const float stretch = excess * excess * excess / (excess * excess + noise * noise);
  newtons = known * std::exp(stretch);
  const float of_law = stretch * std::hypot(kExponentSigma, kExponentChange * stretch);
  sigma = newtons * std::hypot(noise, of_law, bend_error(networks_.end_bends[1], stretch));
}

}  // namespace dermis::touch::fusion
