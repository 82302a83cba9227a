// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Time of one frame, one thread, counts to contacts: the pipeline and a ContactTracker on the simulator's scene
// `contacts`, with a model of the scene `calibration`; and the tracker alone.
#include <benchmark/benchmark.h>

#include <chrono>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "frame_times.hpp"
#include "rows.hpp"
#include "support/reference_array.hpp"

namespace dermis {
namespace {

struct Recording {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;
};

Recording record(const ArrayDescription& array, std::string_view scene) {
  auto simulator = learn::simulation::Simulator::create(array, {}, scene, 1);
  Recording recording;
  RawFrame frame;
  while (*simulator.value()->next(frame)) {
    recording.frames.push_back(frame);
    recording.loads.insert(recording.loads.end(), simulator.value()->loads().begin(), simulator.value()->loads().end());
  }
  return recording;
}

/// The scene with contacts, and what the pipeline makes of it.
struct Scene {
  explicit Scene(std::size_t lines)
      : array(support::reference_array(lines, lines)), frames(record(array, "contacts").frames) {
    const Recording presses = record(array, "calibration");
    model = learn::calibration::calibrate(array, presses.frames, presses.loads).value().model;
  }
  ArrayDescription array;
  std::vector<RawFrame> frames;
  touch::pipeline::Model model;
};

const Scene& scene() {
  static const Scene kScene(16);
  return kScene;
}

void counts_to_contacts(benchmark::State& state) {
  std::vector<RawFrame> frames = scene().frames;
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(scene().model);
  touch::contacts::ContactTracker tracker(scene().array);
  ForceFrame force;
  ContactReport report;
  Nanos time{0};
  std::size_t contacts = 0;
  benchmarks::measure_frames(state, frames.size(), [&](std::size_t k) {
    frames[k].time = time += std::chrono::milliseconds(10);
    pipeline->process(frames[k], force);
    tracker.process(force, report);
    contacts += report.contacts.size();
  });
  state.counters["checked"] = contacts > 0 ? 1 : 0;
}

std::vector<ForceFrame> scene_forces() {
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(scene().model);
  std::vector<ForceFrame> forces(scene().frames.size());
  for (std::size_t k = 0; k < forces.size(); ++k) pipeline->process(scene().frames[k], forces[k]);
  return forces;
}

void measure_tracker(benchmark::State& state, std::vector<ForceFrame> forces) {
  touch::contacts::ContactTracker tracker(scene().array);
  ContactReport report;
  Nanos time{0};
  benchmarks::measure_frames(state, forces.size(), [&](std::size_t k) {
    forces[k].time = time += std::chrono::milliseconds(10);
    tracker.process(forces[k], report);
    benchmark::DoNotOptimize(report.contacts.data());
  });
  state.counters["checked"] = forces.empty() ? 0 : 1;
}

void newtons_to_contacts(benchmark::State& state) {
  measure_tracker(state, scene_forces());
}

/// Of the scene's frames those with so many contacts, in their order.
void newtons_to_so_many_contacts(benchmark::State& state, std::size_t contacts) {
  const std::vector<ForceFrame> forces = scene_forces();
  touch::contacts::ContactTracker tracker(scene().array);
  ContactReport report;
  std::vector<ForceFrame> chosen;
  for (const ForceFrame& force : forces) {
    tracker.process(force, report);
    if (report.contacts.size() == contacts) chosen.push_back(force);
  }
  measure_tracker(state, std::move(chosen));
}

void newtons_to_no_contact(benchmark::State& state) {
  newtons_to_so_many_contacts(state, 0);
}

void newtons_to_one_contact(benchmark::State& state) {
  newtons_to_so_many_contacts(state, 1);
}

BENCHMARK(counts_to_contacts)->Name("frame: counts to contacts|dermis")->Arg(16)->UseManualTime();
BENCHMARK(newtons_to_contacts)->Name("frame: newtons to contacts|dermis")->Arg(16)->UseManualTime();
BENCHMARK(newtons_to_no_contact)->Name("newtons to no contact|dermis")->Arg(16)->UseManualTime();
BENCHMARK(newtons_to_one_contact)->Name("newtons to one contact|dermis")->Arg(16)->UseManualTime();

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  dermis::benchmarks::FrameTimesReporter reporter("one thread; scene contacts: up to five at once, 8-30 mm, 2-50 N");
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return dermis::benchmarks::write_rows("contacts", reporter.rows()) ? 0 : 1;
}
