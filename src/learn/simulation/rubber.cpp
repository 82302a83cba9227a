// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/rubber.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <string>

#include "learn/simulation/option_range.hpp"

namespace dermis::learn::simulation {
namespace {

constexpr double kReferenceCelsius = 20.0;
constexpr double kReferenceForceN = 10.0;
constexpr std::size_t kCreepElements = std::size(ConductiveRubber::kCreepSeconds);
constexpr std::size_t kNoiseProcesses = std::size(ConductiveRubber::kNoiseCornersHz);
constexpr std::uint64_t kTouchStream = 1;   // Of the noise seed.
constexpr std::uint64_t kAgeingStream = 1;  // Of the piece's seed.

std::string taxel_message(const char* field, std::size_t taxel, std::size_t cols, const char* problem) {
  return std::string(field) + ": leaves taxel r" + std::to_string(taxel / cols) + "c" + std::to_string(taxel % cols) +
         " of this piece (rubber.seed) " + problem;
}

}  // namespace

Status RubberOptions::validate() const {
  constexpr double kMinOhm = 1e-3;
  constexpr double kMaxOhm = 1e12;
  if (Status ranges = check_ranges({{"rubber.resistance_at_10n_ohm", resistance_at_10n_ohm, kMinOhm, kMaxOhm},
                                    {"rubber.resistance_spread", resistance_spread, 0.0, 1.0},
                                    {"rubber.exponent", exponent, 0.1, 3.0},
                                    {"rubber.exponent_spread", exponent_spread, 0.0, 0.3},
                                    {"rubber.unloaded_ohm", unloaded_ohm, kMinOhm, kMaxOhm},
                                    {"rubber.contact_ohm", contact_ohm, 0.0, kMaxOhm},
                                    {"rubber.temperature_coefficient", temperature_coefficient, -0.1, 0.1},
                                    {"rubber.temperature_coefficient_spread", temperature_coefficient_spread, 0.0, 2.0},
                                    {"rubber.temperature_curvature", temperature_curvature, -1e-3, 1e-3},
                                    {"rubber.hysteresis", hysteresis, 0.0, 0.5},
                                    {"rubber.creep", creep, 0.0, 0.5},
                                    {"rubber.gain", gain, 0.1, 10.0},
                                    {"rubber.gain_spread", gain_spread, 0.0, 1.0},
                                    {"rubber.pink_noise", pink_noise, 0.0, 1e-4},
                                    {"rubber.mechanical_spread", mechanical_spread, 0.0, 0.5}});
      !ranges) {
    return ranges;
  }
  if (contact_ohm >= resistance_at_10n_ohm) {
    return bad_input("rubber.contact_ohm: must be less than rubber.resistance_at_10n_ohm");
  }
  if (!memory) return Done{};
  if (hysteresis > 0.0 || creep > 0.0) {
    return bad_input("rubber.hysteresis, rubber.creep: are those of the memory \"simple\"; must be 0 for \"rubber\"");
  }
  return memory->validate();
}

Result<RubberOptions> rubber_grade(int carbon_percent) {
  if (carbon_percent != 5 && carbon_percent != 10 && carbon_percent != 15) {
    return bad_input("rubber.carbon_percent: must be 5, 10 or 15, is " + std::to_string(carbon_percent));
  }
  constexpr double kThresholdPercent = 3.0;
  RubberOptions options;
  const double above = (carbon_percent - kThresholdPercent) / (10.0 - kThresholdPercent);
  const double relative_resistance = 1.0 / (above * above);
  options.resistance_at_10n_ohm *= relative_resistance;
  options.unloaded_ohm *= relative_resistance;
  options.pink_noise *= relative_resistance;
  options.exponent -= 0.02 * (carbon_percent - 10);
  return options;
}

Status choose_memory(const std::string& name, RubberOptions& rubber) {
  if (name != "simple" && name != "rubber") return bad_input("memory: must be simple or rubber, not '" + name + "'");
  if (name == "simple") rubber.memory.reset();
  if (name == "rubber" && !rubber.memory) rubber.memory.emplace();
  return Done{};
}

ConductiveRubber::ConductiveRubber(const RubberOptions& options, std::size_t rows, std::size_t cols,
                                   std::uint64_t noise_seed)
    : options_(options),
      rows_(rows),
      cols_(cols),
      taxels_(rows * cols),
      load_n_(rows * cols),
      previous_n_(rows * cols),
      creep_n_(kCreepElements * rows * cols),
      loop_(rows * cols),
      noise_(kNoiseProcesses * rows * cols),
      random_(noise_seed) {
  const double sd = std::sqrt(options.pink_noise * std::numbers::ln10);
  for (double& state : noise_) state = sd * random_.normal();
  if (options.memory) {
    memory_.emplace(*options.memory, rows * cols, Random::stream(noise_seed, kTouchStream).bits());
  }
}

Result<ConductiveRubber> ConductiveRubber::create(const RubberOptions& options, std::size_t rows, std::size_t cols,
                                                  std::uint64_t noise_seed) {
  if (Status valid = options.validate(); !valid) return valid.error();
  if (rows == 0 || cols == 0) return bad_input("array.rows, array.cols: must be at least 1");
  ConductiveRubber rubber(options, rows, cols, noise_seed);
  if (Status drawn = rubber.draw_taxels(); !drawn) return drawn.error();
  if (options.gain != 1.0 || options.gain_spread > 0.0) rubber.age();
  return rubber;
}

Status ConductiveRubber::draw_taxels() {
  Random piece(options_.seed);
  for (std::size_t i = 0; i < taxels_.size(); ++i) {
    Taxel& taxel = taxels_[i];
    const double at_10n_ohm = options_.resistance_at_10n_ohm * std::exp(options_.resistance_spread * piece.normal());
    taxel.exponent = options_.exponent * (1.0 + options_.exponent_spread * piece.normal());
    taxel.temperature_coefficient =
        options_.temperature_coefficient * (1.0 + options_.temperature_coefficient_spread * piece.normal());
    taxel.scale_ohm = (at_10n_ohm - options_.contact_ohm) * std::pow(kReferenceForceN, taxel.exponent);
    if (taxel.scale_ohm <= 0.0) {
      return bad_input(taxel_message("rubber.contact_ohm", i, cols_, "with less than this at 10 N"));
    }
    if (taxel.exponent <= 0.0) {
      return bad_input(taxel_message("rubber.exponent_spread", i, cols_, "without a positive exponent"));
    }
  }
  return Done{};
}

void ConductiveRubber::age() {
  Random piece = Random::stream(options_.seed, kAgeingStream);
  for (Taxel& taxel : taxels_) {
    const double gain = options_.gain * std::exp(options_.gain_spread * piece.normal());
    taxel.scale_ohm *= std::pow(gain, -taxel.exponent);
  }
}

void ConductiveRubber::press(std::span<const double> force_n, double seconds) {
  assert(force_n.size() == taxels_.size() && seconds >= 0.0);
  previous_n_.swap(load_n_);
  share_load(force_n);
  if (options_.hysteresis > 0.0) follow_loop();
  if (options_.creep > 0.0) creep_towards_load(seconds);
  if (memory_) memory_->press(load_n_, seconds);
  unread_seconds_ += seconds;
}

void ConductiveRubber::share_load(std::span<const double> force_n) {
  if (options_.mechanical_spread == 0.0) {
    std::copy(force_n.begin(), force_n.end(), load_n_.begin());
    return;
  }
  const double kept = 1.0 - options_.mechanical_spread;
  const double given = options_.mechanical_spread / 4.0;
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) {
      const std::size_t i = row * cols_ + col;
      double neighbours_n = 0.0;
      if (row > 0) neighbours_n += force_n[i - cols_];
      if (row + 1 < rows_) neighbours_n += force_n[i + cols_];
      if (col > 0) neighbours_n += force_n[i - 1];
      if (col + 1 < cols_) neighbours_n += force_n[i + 1];
      load_n_[i] = kept * force_n[i] + given * neighbours_n;
    }
  }
}

void ConductiveRubber::follow_loop() {
  for (std::size_t i = 0; i < loop_.size(); ++i) {
    const double change = std::log1p(load_n_[i]) - std::log1p(previous_n_[i]);
    loop_[i] = std::clamp(loop_[i] + change / kHysteresisReach, -1.0, 1.0);
  }
}

void ConductiveRubber::creep_towards_load(double seconds) {
  for (std::size_t k = 0; k < kCreepElements; ++k) {
    const double approach = -std::expm1(-seconds / kCreepSeconds[k]);
    double* const material_n = creep_n_.data() + k * taxels_.size();
    for (std::size_t i = 0; i < taxels_.size(); ++i) material_n[i] += (load_n_[i] - material_n[i]) * approach;
  }
}

// Lorentzians of equal variance with corners a decade apart add up to K/f when each has the variance K ln 10. The sum
// over the corners f_k of `2 v / (pi f_k) / (1 + (f/f_k)^2)` is, as an integral over log10 f_k, `v / (f ln 10)`.
void ConductiveRubber::advance_noise() {
  const double sd = std::sqrt(options_.pink_noise * std::numbers::ln10);
  for (std::size_t k = 0; k < kNoiseProcesses; ++k) {
    const double decay = 2.0 * std::numbers::pi * kNoiseCornersHz[k] * unread_seconds_;
    const double kept = std::exp(-decay);
    const double fresh = sd * std::sqrt(-std::expm1(-2.0 * decay));
    double* const state = noise_.data() + k * taxels_.size();
    for (std::size_t i = 0; i < taxels_.size(); ++i) state[i] = kept * state[i] + fresh * random_.normal();
  }
}

void ConductiveRubber::read(double temperature_celsius, std::span<double> siemens) {
  read(std::vector<double>(taxels_.size(), temperature_celsius), siemens);
}

void ConductiveRubber::read(std::span<const double> taxel_celsius, std::span<double> siemens) {
  assert(siemens.size() == taxels_.size() && taxel_celsius.size() == taxels_.size());
  if (options_.pink_noise > 0.0 && unread_seconds_ > 0.0) advance_noise();
  unread_seconds_ = 0.0;
  for (std::size_t i = 0; i < taxels_.size(); ++i) {
    siemens[i] = conductance(i, unloaded_siemens(i), effective_force(i), taxel_celsius[i]) * (1.0 + relative_noise(i));
  }
}

double ConductiveRubber::effective_force(std::size_t taxel) const {
  if (memory_) return memory_->material_force(taxel);
  double late_n = 0.0;
  for (std::size_t k = 0; k < kCreepElements; ++k) late_n += creep_n_[k * taxels_.size() + taxel];
  late_n /= static_cast<double>(kCreepElements);
  const double material_n = load_n_[taxel] * (1.0 - options_.creep) + options_.creep * late_n;
  return material_n * (1.0 - options_.hysteresis / 2.0 * loop_[taxel]);
}

double ConductiveRubber::unloaded_siemens(std::size_t taxel) const {
  return memory_ ? memory_->unloaded_share(taxel) / options_.unloaded_ohm : 1.0 / options_.unloaded_ohm;
}

double ConductiveRubber::relative_noise(std::size_t taxel) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < kNoiseProcesses; ++k) sum += noise_[k * taxels_.size() + taxel];
  return sum;
}

double ConductiveRubber::temperature_factor(std::size_t taxel, double temperature_celsius) const {
  const double difference = temperature_celsius - kReferenceCelsius;
  return std::exp(taxels_[taxel].temperature_coefficient * difference +
                  options_.temperature_curvature * difference * difference);
}

double ConductiveRubber::conductance_from_force(std::size_t taxel, double force_n, double temperature_celsius) const {
  return conductance(taxel, 1.0 / options_.unloaded_ohm, force_n, temperature_celsius);
}

double ConductiveRubber::conductance(std::size_t taxel, double unloaded_siemens, double force_n,
                                     double temperature_celsius) const {
  double siemens = unloaded_siemens;
  if (force_n > 0.0) {
    const Taxel& law = taxels_[taxel];
    siemens += 1.0 / (options_.contact_ohm + law.scale_ohm * std::pow(force_n, -law.exponent));
  }
  return siemens / temperature_factor(taxel, temperature_celsius);
}

double ConductiveRubber::force_from_conductance(std::size_t taxel, double siemens, double temperature_celsius) const {
  const double pressed_siemens = siemens * temperature_factor(taxel, temperature_celsius) - 1.0 / options_.unloaded_ohm;
  if (pressed_siemens <= 0.0) return 0.0;
  const double power_law_ohm = 1.0 / pressed_siemens - options_.contact_ohm;
  if (power_law_ohm <= 0.0) return std::numeric_limits<double>::infinity();
  return std::pow(taxels_[taxel].scale_ohm / power_law_ohm, 1.0 / taxels_[taxel].exponent);
}

}  // namespace dermis::learn::simulation
