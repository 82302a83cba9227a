// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Frames until each fault of a 16x16 array is found (docs/reasons/health.md, "How soon"):
// fault_campaign [SEEDS [FAULT_FROM_FRAME [SIZE [IDLE_COUNTS]]]]. Unloaded taxels read about IDLE_COUNTS, and lines
// that are open exactly 0, where they are given.
#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/quantile.hpp"
#include "support/healthy_arrays.hpp"
#include "support/reference_array.hpp"

namespace {

using dermis::learn::simulation::LineFaults;
using dermis::touch::compensation::LineFaultKind;

constexpr std::size_t kWithinFrames = 3000;

struct FaultCase {
  const char* name;
  LineFaultKind kind;
  std::function<void(LineFaults&, const dermis::ArrayDescription&, std::size_t)> put;
};

std::vector<FaultCase> fault_cases() {
  using Kind = LineFaultKind;
  return {
      {"open row", Kind::silent_row, [](auto& f, auto&, auto k) { f.rows.open = {k}; }},
      {"open column", Kind::silent_column, [](auto& f, auto&, auto k) { f.columns.open = {k}; }},
      {"supplied row", Kind::supplied_row, [](auto& f, auto&, auto k) { f.rows.supplied = {k}; }},
      {"supplied column", Kind::supplied_column, [](auto& f, auto&, auto k) { f.columns.supplied = {k}; }},
      {"shorted rows", Kind::shorted_rows, [](auto& f, auto&, auto k) { f.rows.shorted = {k}; }},
      {"shorted columns", Kind::shorted_columns, [](auto& f, auto&, auto k) { f.columns.shorted = {k}; }},
      {"stuck taxel", Kind::stuck_taxel,
       [](auto& f, auto& array, auto k) { f.stuck_taxels = {array.taxel_name(array.index(k, k))}; }},
      {"dead taxel", Kind::dead_taxel,
       [](auto& f, auto& array, auto k) { f.dead_taxels = {array.taxel_name(array.index(k, k))}; }},
  };
}

/// The frames that it takes, or none where it is not found, or where another one is before.
std::optional<std::size_t> frames_to_detection(const FaultCase& fault, std::size_t size, std::uint64_t seed,
                                               std::size_t from_frame, std::size_t idle_counts) {
  dermis::support::HealthyArray watched;
  watched.array = dermis::support::reference_circuit(size, size);
  dermis::Random random(seed);
  fault.put(watched.options.faults, watched.array, random.below(size - 1));
  watched.options.faults.from_frame = from_frame;
  watched.options.rubber.seed = seed;
  if (idle_counts > 0) {
    const dermis::Readout& readout = watched.array.readout;
    watched.options.rubber.unloaded_ohm =
        readout.load_ohm.front() * readout.full_scale_counts() / static_cast<double>(idle_counts);
    watched.options.environment.adc_noise_lsb = 0.1;
  }
  const std::size_t frames = from_frame + kWithinFrames;
  const auto simulator =
      dermis::learn::simulation::Simulator::create(watched.array, watched.options, "multitouch", seed, frames).value();
  auto compensator = dermis::touch::compensation::Compensator::create(watched.array).value();
  const std::vector<double> unloaded(watched.array.taxel_count(), 1.0 / watched.options.rubber.unloaded_ohm);
  dermis::touch::compensation::LineFaultMonitor monitor(watched.array, unloaded);
  dermis::ConductanceFrame conductance;
  dermis::RawFrame raw;
  for (std::size_t frame = 0; frame < frames && *simulator->next(raw); ++frame) {
    const dermis::ConditionedFrame conditioned = dermis::support::conditioned_frame(watched, raw);
    compensator.process(conditioned, conductance);
    if (!monitor.observe(conditioned, conductance)) continue;
    const bool is_right = monitor.faults().front().kind == fault.kind && frame >= from_frame;
    return is_right ? std::optional(frame + 1 - from_frame) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int k, std::size_t otherwise) {
    return argc > k ? static_cast<std::size_t>(std::strtoull(argv[k], nullptr, 10)) : otherwise;
  };
  const std::size_t seeds = argument(1, 20);
  const std::size_t from_frame = argument(2, 100);
  const std::size_t size = argument(3, 16);
  const std::size_t idle_counts = argument(4, 0);
  fmt::print("{0}x{0}, {1} seeds, fault from frame {2}\n", size, seeds, from_frame);
  fmt::print("{:<16} {:>6} {:>6} {:>6}  not found\n", "frames to", "least", "median", "most");
  for (const FaultCase& fault : fault_cases()) {
    std::vector<std::size_t> frames;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      if (const auto found = frames_to_detection(fault, size, seed, from_frame, idle_counts)) frames.push_back(*found);
    }
    std::sort(frames.begin(), frames.end());
    const auto at = [&](double share) { return frames.empty() ? 0 : dermis::quantile(frames, share); };
    fmt::print("{:<16} {:>6} {:>6} {:>6}  {}\n", fault.name, at(0.0), at(0.5), at(1.0), seeds - frames.size());
    std::fflush(stdout);
  }
  return 0;
}
