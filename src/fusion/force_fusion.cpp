// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/fusion/force_fusion.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace dermis::fusion {
namespace {

constexpr float kLeastShare = 1e-20F;  // of the reference: keeps ln(e) finite
constexpr float kNoForce = std::numeric_limits<float>::quiet_NaN();

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
         all(parameters, shape.parameter_count() * taxels, is_finite) &&
         rises_with_conductance(shape, parameters, taxels);
}

ForceFusion::ForceFusion(ForceNetworks networks)
    : networks_(std::move(networks)),
      bank_(networks_.shape, networks_.taxel_count(), networks_.parameters),
      excess_siemens_(networks_.taxel_count()),
      inputs_(networks_.shape.inputs * networks_.taxel_count()),
      outputs_(networks_.taxel_count()) {
  assert(networks_.is_consistent());
}

void ForceFusion::process(const ConductanceFrame& conductance, ForceFrame& force) noexcept {
  const std::size_t taxels = networks_.taxel_count();
  force.time = conductance.time;
  force.status = conductance.status;
  force.taxels = conductance.taxels;
  force.newtons.resize(taxels);
  if (has(conductance.status, FrameStatus::rejected) || conductance.siemens.size() != taxels) {
    force.status |= FrameStatus::rejected;
    force.taxels.assign(taxels, TaxelStatus::invalid);
    std::fill(force.newtons.begin(), force.newtons.end(), kNoForce);
    return;
  }
  prepare_inputs(conductance, temperature_offset(conductance, force));
  bank_.evaluate(inputs_, outputs_);
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) finish(taxel, force);
}

double ForceFusion::temperature_offset(const ConductanceFrame& conductance, ForceFrame& force) const noexcept {
  if (!conductance.temperature_celsius) {
    if (uses_temperature()) force.status |= FrameStatus::temperature_unknown;
    return 0.0;
  }
  const double half_span = networks_.temperature_half_span_celsius;
  const double offset = *conductance.temperature_celsius - networks_.temperature_centre_celsius;
  const double clamped = std::clamp(offset, -half_span, half_span);
  constexpr double kSensorNoiseCelsius = 1.0;
  const bool is_outside = std::abs(offset - clamped) > kSensorNoiseCelsius;
  if (uses_temperature() && is_outside) force.status |= FrameStatus::temperature_clamped;
  return clamped;
}

void ForceFusion::prepare_inputs(const ConductanceFrame& conductance, double temperature_offset) noexcept {
  const std::size_t taxels = networks_.taxel_count();
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const double offset = networks_.offset_siemens[taxel] + networks_.offset_per_celsius[taxel] * temperature_offset;
    const auto excess = static_cast<float>(conductance.siemens[taxel] - offset);
    excess_siemens_[taxel] = excess;
    const float reference = networks_.reference_siemens[taxel];
    const float calibrated = std::min(excess, networks_.heaviest_siemens[taxel]);
    const float share = std::max(calibrated / reference, kLeastShare);
    inputs_[taxel] = std::log(share);
    inputs_[taxels + taxel] = share - 1.0F;
  }
  if (!uses_temperature()) return;
  const auto t = static_cast<float>(temperature_offset / networks_.temperature_half_span_celsius);
  std::fill(inputs_.begin() + static_cast<std::ptrdiff_t>(2 * taxels), inputs_.end(), t);
}

void ForceFusion::finish(std::size_t taxel, ForceFrame& force) const noexcept {
  TaxelStatus& status = force.taxels[taxel];
  float& newtons = force.newtons[taxel];
  if (networks_.dead[taxel] != 0) {
    status = TaxelStatus::dead;
    force.status |= FrameStatus::dead_taxels;
  } else if (std::isnan(excess_siemens_[taxel])) {
    status = TaxelStatus::invalid;
  }
  if (status == TaxelStatus::dead || status == TaxelStatus::invalid || status == TaxelStatus::line_fault) {
    newtons = kNoForce;
    return;
  }
  const float excess = excess_siemens_[taxel];
  newtons = 0.0F;
  if (excess <= 0.0F) return;
  newtons = networks_.gain[taxel] * std::exp(outputs_[taxel]);
  if (excess <= networks_.heaviest_siemens[taxel] && newtons <= networks_.heaviest_newtons[taxel]) return;
  newtons = std::min(newtons, networks_.heaviest_newtons[taxel]);
  if (status == TaxelStatus::ok) status = TaxelStatus::above_range;
  force.status |= FrameStatus::above_range;
}

}  // namespace dermis::fusion
