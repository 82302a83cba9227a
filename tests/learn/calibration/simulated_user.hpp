// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/guided_calibration.hpp"
#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/learn/simulation/rubber.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/random.hpp"
#include "learn/calibration/simulated.hpp"

namespace dermis::learn::calibration {

/// An array under the hand of a person, 100 frames a second.
class HandledArray {
 public:
  static constexpr double kFrameSeconds = 0.01;

  HandledArray(const ArrayDescription& array, const simulation::RubberOptions& rubber, std::uint64_t seed)
      : array_(array),
        rubber_(*simulation::ConductiveRubber::create(rubber, array.rows, array.cols, seed)),
        circuit_(*simulation::ReadoutCircuit::create(array)),
        adc_(array.readout, 1.0),
        random_(seed),
        siemens_(array.taxel_count()),
        ratio_(array.taxel_count()) {}

  /// The frame after another 10 ms under `force_n` [rows, cols].
  RawFrame frame(const std::vector<double>& force_n) {
    rubber_.press(force_n, kFrameSeconds);
    rubber_.read(celsius_, siemens_);
    circuit_.ratios(siemens_, ratio_);
    RawFrame frame;
    frame.time = Nanos(std::llround(1e9 * kFrameSeconds * static_cast<double>(++frames_)));
    frame.temperature_celsius = celsius_ + 0.1 * random_.normal();
    const double supply_v = 5.0 * (1.0 + 0.02 * random_.uniform(-1.0, 1.0));
    frame.supply_v = supply_v * (1.0 + 0.0005 * random_.normal());
    frame.counts.resize(array_.taxel_count());
    adc_.convert(ratio_, supply_v, random_, frame.counts);
    return frame;
  }

  [[nodiscard]] double seconds() const { return kFrameSeconds * static_cast<double>(frames_); }

 private:
  ArrayDescription array_;
  simulation::ConductiveRubber rubber_;
  simulation::ReadoutCircuit circuit_;
  simulation::Adc adc_;
  Random random_;
  double celsius_ = 23.0;
  std::size_t frames_ = 0;
  std::vector<double> siemens_;
  std::vector<double> ratio_;
};

/// How well a person does what the guide says.
struct Sloppiness {
  double weight_error = 0.0;  ///< Relative standard deviation of the force of a press about its weight.
  double wobble = 0.0;        ///< The same of each frame of a press.
  double wrong_taxel = 0.0;   ///< Share of the presses that begin on another taxel,
  double too_short = 0.0;     ///< that are taken off too early,
  double shaken = 0.0;        ///< and that are pushed while they are held.
};

/// Reads what the guide says and does it, as a person would: looks, puts the weight on within a tenth of a second,
/// waits, takes it off when told.
class SimulatedUser {
 public:
  SimulatedUser(const ArrayDescription& array, const Sloppiness& sloppiness, std::uint64_t seed)
      : sloppiness_(sloppiness), random_(seed), force_n_(array.taxel_count()) {}

  /// What presses on the array in the next 10 ms.
  const std::vector<double>& react(const GuideState& guide) {
    seconds_ += HandledArray::kFrameSeconds;
    if (target_) {
      hold(guide);
    } else if (guide.stage == GuideStage::pressing && guide.hint != GuideHint::release && seconds_ > kReactionSeconds) {
      put_on(guide);
    }
    return force_n_;
  }

  std::size_t wrong_taxels = 0;
  std::size_t short_presses = 0;

 private:
  static constexpr double kReactionSeconds = 0.3;
  static constexpr double kPutOnSeconds = 0.1;
  static constexpr double kShortSeconds = 0.5;

  void put_on(const GuideState& guide) {
    target_ = guide.taxel;
    together_with_ = guide.together_with;
    if (random_.uniform() < sloppiness_.wrong_taxel) {
      target_ = (guide.taxel + 1 + random_.below(force_n_.size() - 1)) % force_n_.size();
      ++wrong_taxels;
    }
    newtons_ = guide.weight_n * (1.0 + sloppiness_.weight_error * random_.normal());
    is_short_ = random_.uniform() < sloppiness_.too_short;
    shake_at_ = random_.uniform() < sloppiness_.shaken ? 0.8 : 1e9;
    seconds_ = 0.0;
  }

  void hold(const GuideState& guide) {
    const bool is_wrong = guide.hint == GuideHint::other_taxel && seconds_ > 2.0 * kReactionSeconds;
    const bool is_early = is_short_ && seconds_ > kShortSeconds;
    const bool is_over = guide.hint == GuideHint::release || guide.stage != GuideStage::pressing;
    if (is_wrong || is_early || is_over) {
      short_presses += is_early ? 1 : 0;
      force_n_.assign(force_n_.size(), 0.0);
      target_.reset();
      seconds_ = 0.0;
      return;
    }
    const double put_on = std::min(1.0, seconds_ / kPutOnSeconds);
    const double shake = seconds_ > shake_at_ && seconds_ < shake_at_ + 0.2 ? 1.4 : 1.0;
    if (together_with_) force_n_[*together_with_] = newtons_ * put_on;
    force_n_[*target_] = newtons_ * put_on * shake * (1.0 + sloppiness_.wobble * random_.normal());
  }

  Sloppiness sloppiness_;
  Random random_;
  std::vector<double> force_n_;
  std::optional<std::size_t> target_;
  std::optional<std::size_t> together_with_;
  double newtons_ = 0.0;
  bool is_short_ = false;
  double shake_at_ = 0.0;
  double seconds_ = 0.0;  // since the hand moved
};

}  // namespace dermis::learn::calibration
