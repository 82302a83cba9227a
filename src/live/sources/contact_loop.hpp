// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "dermis/learn/simulation/rubber.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::sources {

/// Hears which share of a scene is simulated.
using SceneProgress = std::function<void(double share)>;

/// The scene "contacts" to be read at any moment, over and over. It is simulated beforehand at 100 frames/s without the
/// noise of the instruments, and interpolated in between. Each reading has fresh noise. Not thread-safe.
class ContactLoop {
 public:
  /// `frames`: length of the scene; by default 2000 (20 s), or fewer of more than 6000 taxels.
  [[nodiscard]] static Result<ContactLoop> create(const ArrayDescription& array, std::uint64_t seed,
                                                  std::optional<std::size_t> frames,
                                                  const learn::simulation::RubberOptions& rubber = {},
                                                  const SceneProgress& progress = {});

  /// Counts, temperature and supply `seconds` >= 0 after the beginning of the first loop.
  void read(double seconds, RawFrame& frame);

 private:
  ContactLoop(const Readout& readout, std::size_t taxels, std::uint64_t seed);
  void append(const RawFrame& exact, double temperature_celsius, double supply_v);

  Readout readout_;
  std::size_t taxels_;
  Random random_;
  std::vector<float> noise_;  // Normal numbers [counts]; a frame takes them from a random place on.
  std::vector<float> ratio_;  // [frames, taxels] reading over supply
  std::vector<double> temperature_celsius_;
  std::vector<double> supply_v_;
};

}  // namespace dermis::live::sources
