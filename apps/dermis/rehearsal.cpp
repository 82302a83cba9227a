// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "rehearsal.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "dermis/simulation/scene.hpp"

namespace dermis::app {
namespace {

using calibration::GuideHint;
using calibration::GuideStage;

constexpr double kCelsius = 22.0;
constexpr double kDefaultSupplyV = 5.0;
constexpr std::uint64_t kPressesToAMistake = 8;
constexpr double kSeesMistakeSeconds = 0.6;  // the page hears ten times a second
constexpr simulation::EnvironmentOptions kEnvironment;

}  // namespace

GuideVoice& guide_voice() {
  static GuideVoice voice;
  return voice;
}

void GuideVoice::say(const calibration::GuideState& state, Nanos hold_time) {
  const std::lock_guard lock(mutex_);
  words_ = {state.stage, state.hint, state.taxel, state.weight_n, hold_time};
}

GuideVoice::Words GuideVoice::words() const {
  const std::lock_guard lock(mutex_);
  return words_;
}

Rehearsal::Rehearsal(const ArrayDescription& array, simulation::ConductiveRubber rubber,
                     simulation::ReadoutCircuit circuit, std::uint64_t seed, double rate_hz)
    : rubber_(std::move(rubber)),
      circuit_(std::move(circuit)),
      adc_(array.readout, kEnvironment.adc_noise_lsb),
      random_(seed),
      frame_seconds_(1.0 / rate_hz),
      supply_v_(array.readout.supply_v.value_or(kDefaultSupplyV)),
      force_n_(array.taxel_count()),
      siemens_(array.taxel_count()),
      ratio_(array.taxel_count()) {}

Result<Rehearsal> Rehearsal::create(const ArrayDescription& array, std::uint64_t seed, double rate_hz) {
  Result<simulation::ConductiveRubber> rubber = simulation::ConductiveRubber::create({}, array.rows, array.cols, seed);
  if (!rubber) return rubber.error();
  Result<simulation::ReadoutCircuit> circuit = simulation::ReadoutCircuit::create(array);
  if (!circuit) return circuit.error();
  guide_voice().listen();
  return Rehearsal(array, *std::move(rubber), *std::move(circuit), seed, rate_hz);
}

void Rehearsal::put_on(const GuideVoice::Words& words) {
  const bool is_mistake = ++presses_ % kPressesToAMistake == 0;
  pressed_ = (words.taxel + (is_mistake ? 1 : 0)) % force_n_.size();
  force_n_[*pressed_] = words.weight_n;
  seconds_ = 0.0;
}

void Rehearsal::move_hand(double seconds) {
  const GuideVoice::Words words = guide_voice().words();
  const double while_s = std::chrono::duration<double>(words.hold_time).count();
  const bool is_asked = words.stage == GuideStage::pressing && words.hint != GuideHint::release;
  seconds_ += seconds;
  if (!pressed_) {
    if (is_asked && seconds_ > while_s && words.taxel < force_n_.size()) put_on(words);
    return;
  }
  const bool sees_mistake = words.hint == GuideHint::other_taxel && seconds_ > while_s + kSeesMistakeSeconds;
  told_seconds_ = is_asked ? 0.0 : told_seconds_ + seconds;
  if (!sees_mistake && told_seconds_ <= 0.5 * while_s) return;
  force_n_[*pressed_] = 0.0;
  pressed_.reset();
  seconds_ = 0.0;
  told_seconds_ = 0.0;
}

void Rehearsal::read(std::uint64_t number, RawFrame& frame) {
  const double seconds = frame_seconds_ * static_cast<double>(number + 1 - next_);
  next_ = number + 1;
  move_hand(seconds);
  rubber_.press(force_n_, seconds);
  rubber_.read(kCelsius, siemens_);
  circuit_.ratios(siemens_, ratio_);
  frame.temperature_celsius = kCelsius + kEnvironment.temperature_noise_celsius * random_.normal();
  frame.supply_v = supply_v_ * (1.0 + kEnvironment.supply_noise * random_.normal());
  frame.counts.resize(ratio_.size());
  adc_.convert(ratio_, supply_v_, random_, frame.counts);
}

}  // namespace dermis::app
