// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/fusion/force_fusion.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace dermis::fusion {
namespace {

constexpr float kLeastShare = 1e-20F;  // of the reference: keeps ln(e) finite
constexpr float kNoForce = std::numeric_limits<float>::quiet_NaN();
constexpr float kNoUpperBound = std::numeric_limits<float>::infinity();

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

}  // namespace

bool ForceNetworks::is_consistent() const noexcept {
  const auto is_finite = [](auto value) { return std::isfinite(value); };
  const auto is_positive = [](auto value) { return std::isfinite(value) && value > 0; };
  const auto is_not_negative = [](auto value) { return std::isfinite(value) && value >= 0; };
  const std::size_t taxels = taxel_count();
  const bool uses_temperature = shape.inputs == kInputsWithTemperature;
  const bool in_range = (uses_temperature || shape.inputs + 1 == kInputsWithTemperature) && shape.hidden <= 64 &&
                        std::isfinite(temperature_centre_celsius) && std::isfinite(temperature_half_span_celsius) &&
                        temperature_half_span_celsius >= 0.0 &&  // std::clamp needs low <= high
                        (!uses_temperature || temperature_half_span_celsius > 0.0);
  return in_range && all(offset_siemens, taxels, is_finite) && all(offset_per_celsius, taxels, is_finite) &&
         all(reference_siemens, taxels, is_positive) && all(heaviest_siemens, taxels, is_positive) &&
         all(heaviest_newtons, taxels, [](float value) { return value > 0.0F; }) && all(gain, taxels, is_positive) &&
         all(dead, taxels, [](std::uint8_t value) { return value <= 1; }) &&
         all(parameters, shape.parameter_count() * taxels, is_finite) && std::isfinite(temperature_sigma_celsius) &&
         temperature_sigma_celsius >= 0.0 && all(offset_sigma_siemens, taxels, is_not_negative) &&
         all(relative_sigma, taxels, is_positive) && rises_with_conductance(shape, parameters, taxels);
}

ForceFusion::ForceFusion(ForceNetworks networks)
    : networks_(std::move(networks)),
      bank_(networks_.shape, networks_.taxel_count(), networks_.parameters),
      excess_siemens_(networks_.taxel_count()),
      sigma_siemens_(networks_.taxel_count()),
      inputs_(networks_.shape.inputs * networks_.taxel_count()),
      outputs_(networks_.taxel_count()),
      gradient_(inputs_.size()) {
  assert(networks_.is_consistent());
}

void ForceFusion::process(const ConductanceFrame& conductance, ForceFrame& force) noexcept {
  const std::size_t taxels = networks_.taxel_count();
  force.time = conductance.time;
  force.status = conductance.status;
  force.taxels = conductance.taxels;
  force.newtons.resize(taxels);
  force.sigma_newtons.resize(taxels);
  const bool fits = conductance.siemens.size() == taxels && conductance.sigma_siemens.size() == taxels;
  if (has(conductance.status, FrameStatus::rejected) || !fits) {
    force.status |= FrameStatus::rejected;
    force.taxels.assign(taxels, TaxelStatus::invalid);
    std::fill(force.newtons.begin(), force.newtons.end(), kNoForce);
    std::fill(force.sigma_newtons.begin(), force.sigma_newtons.end(), kNoForce);
    return;
  }
  const Temperature temperature = this->temperature(conductance, force);
  prepare_inputs(conductance, temperature);
  bank_.evaluate(inputs_, outputs_, gradient_);
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) finish(taxel, temperature, force);
}

ForceFusion::Temperature ForceFusion::temperature(const ConductanceFrame& conductance,
                                                  ForceFrame& force) const noexcept {
  const double half_span = networks_.temperature_half_span_celsius;
  if (!conductance.temperature_celsius) {
    if (uses_temperature()) force.status |= FrameStatus::temperature_unknown;
    return {0.0, half_span / std::numbers::sqrt3};  // anywhere in the calibrated span
  }
  const double offset = *conductance.temperature_celsius - networks_.temperature_centre_celsius;
  const double clamped = std::clamp(offset, -half_span, half_span);
  const double outside = std::abs(offset - clamped);
  constexpr double kSensorNoiseCelsius = 1.0;
  if (uses_temperature() && outside > kSensorNoiseCelsius) force.status |= FrameStatus::temperature_clamped;
  return {clamped, std::hypot(networks_.temperature_sigma_celsius, outside)};
}

void ForceFusion::prepare_inputs(const ConductanceFrame& conductance, const Temperature& temperature) noexcept {
  const std::size_t taxels = networks_.taxel_count();
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const double offset = networks_.offset_siemens[taxel] + networks_.offset_per_celsius[taxel] * temperature.offset;
    const auto excess = static_cast<float>(conductance.siemens[taxel] - offset);
    const auto noise = static_cast<float>(conductance.sigma_siemens[taxel]);
    const float offset_sigma = networks_.offset_sigma_siemens[taxel];
    const float sigma = std::sqrt(noise * noise + offset_sigma * offset_sigma);
    excess_siemens_[taxel] = excess;
    sigma_siemens_[taxel] = sigma;
    const float reference = networks_.reference_siemens[taxel];
    // An unloaded taxel has no force, but a detection limit: the network is asked for the force of one sigma.
    const float calibrated = std::min(excess <= 0.0F ? sigma : excess, networks_.heaviest_siemens[taxel]);
    const float share = std::max(calibrated / reference, kLeastShare);
    inputs_[taxel] = std::log(share);
    inputs_[taxels + taxel] = share - 1.0F;
  }
  if (!uses_temperature()) return;
  const auto t = static_cast<float>(temperature.offset / networks_.temperature_half_span_celsius);
  std::fill(inputs_.begin() + static_cast<std::ptrdiff_t>(2 * taxels), inputs_.end(), t);
}

void ForceFusion::finish(std::size_t taxel, const Temperature& temperature, ForceFrame& force) const noexcept {
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
    return;
  }
  const float excess = excess_siemens_[taxel];
  newtons = networks_.gain[taxel] * std::exp(outputs_[taxel]);
  sigma = sigma_newtons(taxel, newtons, temperature.sigma);
  if (excess <= 0.0F) newtons = 0.0F;
  const bool is_above = excess > networks_.heaviest_siemens[taxel] || newtons > networks_.heaviest_newtons[taxel];
  if (is_above) {
    newtons = std::min(newtons, networks_.heaviest_newtons[taxel]);
    if (status == TaxelStatus::ok) status = TaxelStatus::above_range;
    force.status |= FrameStatus::above_range;
  }
  if (status == TaxelStatus::above_range || status == TaxelStatus::saturated) sigma = kNoUpperBound;
}

float ForceFusion::sigma_newtons(std::size_t taxel, float newtons, double temperature_sigma) const noexcept {
  const std::size_t taxels = networks_.taxel_count();
  const float share = inputs_[taxels + taxel] + 1.0F;
  const float exponent = gradient_[taxel] + gradient_[taxels + taxel] * share;  // p
  const float least = sigma_siemens_[taxel] / networks_.reference_siemens[taxel];
  const float reached = std::max(share, least);
  const float noise = exponent * least / reached;
  float per_celsius = -exponent * static_cast<float>(networks_.offset_per_celsius[taxel]) /
                      (reached * networks_.reference_siemens[taxel]);
  if (uses_temperature()) {
    per_celsius += gradient_[2 * taxels + taxel] / static_cast<float>(networks_.temperature_half_span_celsius);
  }
  const float drift = per_celsius * static_cast<float>(temperature_sigma);
  const float material = networks_.relative_sigma[taxel];
  const float relative = std::sqrt(noise * noise + drift * drift + material * material);
  const float at_reached = share < least ? newtons * std::pow(least / share, exponent) : newtons;
  return std::max(at_reached * relative, std::numeric_limits<float>::min());
}

}  // namespace dermis::fusion
