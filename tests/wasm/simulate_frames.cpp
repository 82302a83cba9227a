// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Usage: simulate_frames CIRCUIT FRAMES >frames
// Frames of the simulator's moving contacts, for process_frames.
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "circuits.hpp"
#include "dermis/learn/simulation/simulator.hpp"

int main(int argument_count, char** arguments) {
  if (argument_count != 3) return 2;
  const auto array = dermis::wasm::described_array(arguments[1]);
  if (!array) return 2;
  const auto frames = static_cast<std::size_t>(std::atoi(arguments[2]));
  auto simulator = dermis::learn::simulation::Simulator::create(*array, {}, "contacts", 1, frames);
  if (!simulator) return 1;
  dermis::RawFrame raw;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    if (!simulator.value()->next(raw)) return 1;
    std::vector<float> numbers{static_cast<float>(raw.temperature_celsius.value_or(25.0)),
                               static_cast<float>(raw.supply_v.value_or(5.0))};
    numbers.insert(numbers.end(), raw.counts.begin(), raw.counts.end());
    std::fwrite(numbers.data(), sizeof(float), numbers.size(), stdout);
  }
  return 0;
}
