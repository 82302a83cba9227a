// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Time of one frame, one thread, counts to newtons. Frames are those of the simulator's multitouch scene, each a touch
// of its own; the networks have random parameters, as their values do not change the time.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdlib>

#include "dermis/pipeline/pipeline.hpp"
#include "dermis/simulation/simulator.hpp"
#include "frame_times.hpp"
#include "rows.hpp"
#include "support/random_networks.hpp"
#include "support/reference_array.hpp"

namespace dermis {
namespace {

constexpr std::size_t kFrames = 256;

std::vector<RawFrame> multitouch_frames(const ArrayDescription& array) {
  auto simulator = simulation::Simulator::create(array, {}, "multitouch", 1, kFrames);
  std::vector<RawFrame> frames(kFrames);
  for (RawFrame& frame : frames) {
    if (!simulator.value()->next(frame)) std::abort();
  }
  return frames;
}

pipeline::Model random_model(const ArrayDescription& array) {
  pipeline::Model model;
  model.array = array;
  model.networks = support::random_networks(array.taxel_count(), fusion::kInputsWithTemperature, 4, 1);
  // What the simulated array is, unloaded: else its taxels are found to be dead.
  model.networks.unloaded.offset_siemens.assign(array.taxel_count(), 1.0 / simulation::RubberOptions{}.unloaded_ohm);
  return model;
}

void frame_counts_to_newtons(benchmark::State& state) {
  const auto lines = static_cast<std::size_t>(state.range(0));
  const ArrayDescription array = support::reference_array(lines, lines);
  std::vector<RawFrame> frames = multitouch_frames(array);
  Nanos time{0};
  Result<pipeline::Pipeline> pipeline = pipeline::Pipeline::create(random_model(array));
  ForceFrame force;
  bool checked = true;
  benchmarks::measure_frames(state, kFrames, [&](std::size_t k) {
    frames[k].time = time += std::chrono::milliseconds(1);
    pipeline->process(frames[k], force);
    benchmark::DoNotOptimize(force.newtons.data());
    checked =
        checked && !has(force.status, FrameStatus::rejected | FrameStatus::not_converged | FrameStatus::line_fault);
  });
  state.counters["checked"] = checked ? 1 : 0;
}

BENCHMARK(frame_counts_to_newtons)->Name("frame: counts to newtons|dermis")->Arg(16)->Arg(32)->UseManualTime();

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  dermis::benchmarks::FrameTimesReporter reporter("one thread, double precision inversion, single precision networks");
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return dermis::benchmarks::write_rows("pipeline", reporter.rows()) ? 0 : 1;
}
