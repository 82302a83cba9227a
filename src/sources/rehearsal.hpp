// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/random.hpp"
#include "dermis/core/result.hpp"
#include "dermis/simulation/adc.hpp"
#include "dermis/simulation/readout_circuit.hpp"
#include "dermis/simulation/rubber.hpp"
#include "dermis/simulation/sampling_capacitor.hpp"
#include "dermis/sources/guide_voice.hpp"
#include "sources/rehearsing_hand.hpp"

namespace dermis::sources {

/// A simulated array under the hand of somebody who does what the guide says, so that it can be tried without an array.
/// Not thread-safe.
class Rehearsal {
 public:
  /// `guide` null: nobody asks for anything.
  [[nodiscard]] static Result<Rehearsal> create(const ArrayDescription& array, std::uint64_t seed, double rate_hz,
                                                std::shared_ptr<GuideVoice> guide,
                                                const simulation::RubberOptions& rubber = {});

  /// Sets counts, temperature and supply of the frame of that number; numbers rise.
  void read(std::uint64_t number, RawFrame& frame);

 private:
  Rehearsal(const ArrayDescription& array, simulation::ConductiveRubber rubber, simulation::ReadoutCircuit circuit,
            std::uint64_t seed, double rate_hz, std::shared_ptr<GuideVoice> guide);

  std::shared_ptr<GuideVoice> guide_;
  RehearsingHand hand_;
  simulation::ConductiveRubber rubber_;
  simulation::ReadoutCircuit circuit_;
  simulation::SamplingCapacitor capacitor_;
  simulation::Adc adc_;
  Random random_;
  double frame_seconds_;
  double supply_v_;
  std::uint64_t next_ = 0;
  std::vector<double> siemens_;
  std::vector<double> ratio_;
};

}  // namespace dermis::sources
