// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/learn/simulation/rubber.hpp"
#include "dermis/learn/simulation/sampling_capacitor.hpp"
#include "dermis/live/sources/guide_voice.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/frames/result.hpp"
#include "live/sources/rehearsing_hand.hpp"

namespace dermis::live::sources {

/// A simulated array under the hand of somebody who does what the guide says, so that it can be tried without an array.
/// Not thread-safe.
class Rehearsal {
 public:
  /// `guide` null: nobody asks for anything.
  [[nodiscard]] static Result<Rehearsal> create(const ArrayDescription& array, std::uint64_t seed, double rate_hz,
                                                std::shared_ptr<GuideVoice> guide,
                                                const learn::simulation::RubberOptions& rubber = {});

  /// Sets counts, temperature and supply of the frame of that number; numbers rise.
  void read(std::uint64_t number, RawFrame& frame);

 private:
  Rehearsal(const ArrayDescription& array, learn::simulation::ConductiveRubber rubber,
            learn::simulation::ReadoutCircuit circuit, std::uint64_t seed, double rate_hz,
            std::shared_ptr<GuideVoice> guide);

  std::shared_ptr<GuideVoice> guide_;
  RehearsingHand hand_;
  learn::simulation::ConductiveRubber rubber_;
  learn::simulation::ReadoutCircuit circuit_;
  learn::simulation::SamplingCapacitor capacitor_;
  learn::simulation::Adc adc_;
  Random random_;
  double frame_seconds_;
  double supply_v_;
  std::uint64_t next_ = 0;
  std::vector<double> siemens_;
  std::vector<double> ratio_;
};

}  // namespace dermis::live::sources
