// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/sources/rehearsal.hpp"

#include <utility>

#include "dermis/learn/simulation/scene.hpp"

namespace dermis::live::sources {
namespace {

constexpr double kCelsius = 22.0;
constexpr double kDefaultSupplyV = 5.0;
constexpr learn::simulation::EnvironmentOptions kEnvironment;

}  // namespace

Rehearsal::Rehearsal(const ArrayDescription& array, learn::simulation::ConductiveRubber rubber,
                     learn::simulation::ReadoutCircuit circuit, std::uint64_t seed, double rate_hz,
                     std::shared_ptr<GuideVoice> guide)
    : guide_(std::move(guide)),
      hand_(array.taxel_count(), seed),
      rubber_(std::move(rubber)),
      circuit_(std::move(circuit)),
      capacitor_(array),
      adc_(array.readout, kEnvironment.adc_noise_lsb),
      random_(seed),
      frame_seconds_(1.0 / rate_hz),
      supply_v_(array.readout.supply_v.value_or(kDefaultSupplyV)),
      siemens_(array.taxel_count()),
      ratio_(array.taxel_count()) {}

Result<Rehearsal> Rehearsal::create(const ArrayDescription& array, std::uint64_t seed, double rate_hz,
                                    std::shared_ptr<GuideVoice> guide, const learn::simulation::RubberOptions& rubber) {
  Result<learn::simulation::ConductiveRubber> piece =
      learn::simulation::ConductiveRubber::create(rubber, array.rows, array.cols, seed);
  if (!piece) return piece.error();
  Result<learn::simulation::ReadoutCircuit> circuit = learn::simulation::ReadoutCircuit::create(array);
  if (!circuit) return circuit.error();
  if (!guide) guide = std::make_shared<GuideVoice>();
  guide->listen();
  return Rehearsal(array, *std::move(piece), *std::move(circuit), seed, rate_hz, std::move(guide));
}

void Rehearsal::read(std::uint64_t number, RawFrame& frame) {
  const double seconds = frame_seconds_ * static_cast<double>(number + 1 - next_);
  next_ = number + 1;
  rubber_.press(hand_.move(guide_->words(), seconds), seconds);
  rubber_.read(kCelsius, siemens_);
  circuit_.ratios(siemens_, ratio_);
  frame.temperature_celsius = kCelsius + kEnvironment.temperature_noise_celsius * random_.normal();
  frame.supply_v = supply_v_ * (1.0 + kEnvironment.supply_noise * random_.normal());
  frame.counts.resize(ratio_.size());
  capacitor_.sample(ratio_, supply_v_);
  adc_.convert(ratio_, supply_v_, random_, frame.counts);
}

}  // namespace dermis::live::sources
