// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/sources/contact_loop.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "dermis/learn/simulation/simulator.hpp"

namespace dermis::live::sources {
namespace {

constexpr double kSceneRateHz = 100.0;
constexpr std::size_t kFrames = 2000;
constexpr std::size_t kMaxTaxelFrames = 12'000'000;  // 48 MB, simulated within seconds
constexpr std::size_t kNoiseNumbers = 1U << 14U;
constexpr int kExactBits = 24;
constexpr learn::simulation::EnvironmentOptions kEnvironment;

double between(double first, double second, double share) {
  return first + share * (second - first);
}

}  // namespace

ContactLoop::ContactLoop(const Readout& readout, std::size_t taxels, std::uint64_t seed)
    : readout_(readout), taxels_(taxels), random_(seed), noise_(kNoiseNumbers) {
  for (float& number : noise_) number = static_cast<float>(kEnvironment.adc_noise_lsb * random_.normal());
}

Result<ContactLoop> ContactLoop::create(const ArrayDescription& array, std::uint64_t seed,
                                        std::optional<std::size_t> frames,
                                        const learn::simulation::RubberOptions& rubber, const SceneProgress& progress) {
  ArrayDescription exact = array;
  exact.readout.adc_bits = kExactBits;
  exact.readout.adc_reference_v.reset();
  learn::simulation::SimulationOptions options;
  options.environment.adc_noise_lsb = 0.0;
  options.rubber = rubber;
  const std::size_t most = std::max<std::size_t>(1, kMaxTaxelFrames / array.taxel_count());
  const std::size_t length = std::min(frames.value_or(kFrames), most);
  Result<std::unique_ptr<learn::simulation::Simulator>> simulator =
      learn::simulation::Simulator::create(exact, options, "contacts", seed, length);
  if (!simulator) return simulator.error();
  ContactLoop loop(array.readout, array.taxel_count(), seed);
  RawFrame frame;
  for (;;) {
    const Result<bool> more = (*simulator)->next(frame);
    if (!more) return more.error();
    if (!*more) return loop;
    loop.append(frame, (*simulator)->truth().temperature_celsius, (*simulator)->truth().supply_v);
    if (progress) progress(static_cast<double>(loop.supply_v_.size()) / static_cast<double>(length));
  }
}

void ContactLoop::append(const RawFrame& exact, double temperature_celsius, double supply_v) {
  const auto full_scale = static_cast<float>((1U << static_cast<unsigned>(kExactBits)) - 1U);
  for (const float counts : exact.counts) ratio_.push_back(counts / full_scale);
  temperature_celsius_.push_back(temperature_celsius);
  supply_v_.push_back(supply_v);
}

void ContactLoop::read(double seconds, RawFrame& frame) {
  const std::size_t frames = supply_v_.size();
  const double moment = std::fmod(seconds * kSceneRateHz, static_cast<double>(frames));
  const std::size_t first = std::min(static_cast<std::size_t>(moment), frames - 1);
  const std::size_t second = (first + 1) % frames;
  const double share = moment - static_cast<double>(first);
  const double supply_v = between(supply_v_[first], supply_v_[second], share);
  frame.supply_v = supply_v * (1.0 + kEnvironment.supply_noise * random_.normal());
  frame.temperature_celsius = between(temperature_celsius_[first], temperature_celsius_[second], share) +
                              kEnvironment.temperature_noise_celsius * random_.normal();

  const double full_scale = readout_.full_scale_counts();
  const double counts_per_ratio = supply_v / readout_.adc_reference_v.value_or(supply_v) * full_scale;
  const auto of_first = static_cast<float>((1.0 - share) * counts_per_ratio);
  const auto of_second = static_cast<float>(share * counts_per_ratio);
  const float* const earlier = ratio_.data() + first * taxels_;
  const float* const later = ratio_.data() + second * taxels_;
  const std::size_t noise_from = random_.below(kNoiseNumbers);
  const auto most = static_cast<float>(full_scale);
  frame.counts.resize(taxels_);
  for (std::size_t i = 0; i < taxels_; ++i) {
    const float noise = noise_[(noise_from + i) % kNoiseNumbers];
    const float exact = of_first * earlier[i] + of_second * later[i] + noise;
    frame.counts[i] = static_cast<float>(static_cast<std::int32_t>(std::clamp(exact + 0.5F, 0.0F, most)));
  }
}

}  // namespace dermis::live::sources
