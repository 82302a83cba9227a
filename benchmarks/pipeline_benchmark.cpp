// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Time of one frame, one thread, counts to newtons. Frames are those of the simulator's multitouch scene, each a touch
// of its own; the networks have random parameters, as their values do not change the time.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <vector>

#include "dermis/core/random.hpp"
#include "dermis/fusion/material_memory.hpp"
#include "dermis/pipeline/pipeline.hpp"
#include "dermis/simulation/simulator.hpp"
#include "frame_times.hpp"
#include "rows.hpp"
#include "support/random_networks.hpp"
#include "support/reference_array.hpp"

namespace dermis {
namespace {

constexpr std::size_t kFrames = 256;
constexpr fusion::MemoryLaw kLaw{{0.08F, 0.08F, 0.08F, 0.08F}, {0.02F, 0.03F, 0.03F}};

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

void measure_pipeline(benchmark::State& state, bool remembers) {
  const auto lines = static_cast<std::size_t>(state.range(0));
  const ArrayDescription array = support::reference_array(lines, lines);
  std::vector<RawFrame> frames = multitouch_frames(array);
  Nanos time{0};
  pipeline::Model model = random_model(array);
  if (remembers) model.memory = kLaw;
  Result<pipeline::Pipeline> pipeline = pipeline::Pipeline::create(model);
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

void frame_counts_to_newtons(benchmark::State& state) {
  measure_pipeline(state, false);
}

void frame_of_a_material_with_memory(benchmark::State& state) {
  measure_pipeline(state, true);
}

/// Of the forces that the networks give.
void memory_alone(benchmark::State& state) {
  const auto lines = static_cast<std::size_t>(state.range(0));
  fusion::MaterialMemory memory(kLaw, lines * lines);
  const std::vector<float> noise(lines * lines, 1e-3F);
  Random random(1);
  std::vector<ForceFrame> frames(kFrames);
  for (ForceFrame& frame : frames) {
    for (std::size_t taxel = 0; taxel < noise.size(); ++taxel) {
      frame.newtons.push_back(static_cast<float>(random.log_uniform(0.1, 50.0)));
      frame.sigma_newtons.push_back(0.01F * frame.newtons.back());
    }
  }
  ForceFrame force = frames.front();
  Nanos time{0};
  bool checked = true;
  benchmarks::measure_frames(state, kFrames, [&](std::size_t k) {
    std::copy(frames[k].newtons.begin(), frames[k].newtons.end(), force.newtons.begin());
    std::copy(frames[k].sigma_newtons.begin(), frames[k].sigma_newtons.end(), force.sigma_newtons.begin());
    force.time = time += std::chrono::milliseconds(1);
    memory.process(force, noise);
    benchmark::DoNotOptimize(force.newtons.data());
    checked = checked && force.sigma_newtons.front() > 0.0F;
  });
  state.counters["checked"] = checked ? 1 : 0;
}

BENCHMARK(frame_counts_to_newtons)->Name("frame: counts to newtons|dermis")->Arg(16)->Arg(32)->UseManualTime();
BENCHMARK(frame_of_a_material_with_memory)->Name("the same, with memory|dermis")->Arg(16)->Arg(32)->UseManualTime();
BENCHMARK(memory_alone)->Name("memory of the material|dermis")->Arg(16)->Arg(32)->UseManualTime();

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  dermis::benchmarks::FrameTimesReporter reporter("one thread, double precision inversion, single precision networks");
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return dermis::benchmarks::write_rows("pipeline", reporter.rows()) ? 0 : 1;
}
