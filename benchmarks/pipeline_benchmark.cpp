// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Time of one frame, one thread, counts to newtons. Frames are those of the simulator's multitouch scene, each a touch
// of its own; the networks have random parameters, as their values do not change the time.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/fusion/material_memory.hpp"
#include "dermis/touch/fusion/typical_siemens.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "frame_times.hpp"
#include "random_model.hpp"
#include "rows.hpp"
#include "support/reference_array.hpp"

namespace dermis {
namespace {

constexpr std::size_t kFrames = 256;
constexpr touch::fusion::MemoryLaw kLaw{{0.08F, 0.08F, 0.08F, 0.08F}, {0.02F, 0.03F, 0.03F}};

std::vector<RawFrame> frames_of(const ArrayDescription& array, const char* scene) {
  auto simulator = learn::simulation::Simulator::create(array, {}, scene, 1);
  std::vector<RawFrame> frames(std::min(kFrames, simulator.value()->frame_count()));
  for (RawFrame& frame : frames) {
    if (!simulator.value()->next(frame)) std::abort();
  }
  return frames;
}

void measure_pipeline(benchmark::State& state, const touch::pipeline::Model& model, const char* scene) {
  std::vector<RawFrame> frames = frames_of(model.array, scene);
  Nanos time{0};
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(model);
  ForceFrame force;
  bool checked = true;
  benchmarks::measure_frames(state, frames.size(), [&](std::size_t k) {
    frames[k].time = time += std::chrono::milliseconds(1);
    pipeline->process(frames[k], force);
    benchmark::DoNotOptimize(force.newtons.data());
    checked =
        checked && !has(force.status, FrameStatus::rejected | FrameStatus::not_converged | FrameStatus::line_fault);
  });
  state.counters["checked"] = checked ? 1 : 0;
}

touch::pipeline::Model reference_model(const benchmark::State& state) {
  const auto lines = static_cast<std::size_t>(state.range(0));
  return random_model(support::reference_array(lines, lines));
}

void frame_counts_to_newtons(benchmark::State& state) {
  measure_pipeline(state, reference_model(state), "multitouch");
}

void frame_of_a_material_with_memory(benchmark::State& state) {
  touch::pipeline::Model model = reference_model(state);
  model.memory = kLaw;
  measure_pipeline(state, model, "multitouch");
}

/// Circuits that hold a film over their lines.
struct FilmCircuit {
  const char* name = nullptr;
  Circuit circuit = Circuit::divider;
  IdleRows idle_rows = IdleRows::grounded;
  IdleColumns idle_columns = IdleColumns::loaded;
  bool has_offsets = false;
  long most_lines = 32;
};

constexpr FilmCircuit kFilmCircuits[] = {
    {"grounded rows"},
    {"one load", Circuit::divider, IdleRows::grounded, IdleColumns::floating},
    {"flexitac", Circuit::flexitac},
    {"virtual ground", Circuit::transimpedance},
    {"real amplifiers", Circuit::transimpedance, IdleRows::grounded, IdleColumns::loaded, true},
    {"floating rows", Circuit::divider, IdleRows::floating, IdleColumns::loaded, false, 16},
};

struct NamedFilm {
  const char* name = nullptr;
  std::optional<Film> film;
};

constexpr NamedFilm kFilms[] = {{"no film", {}}, {"5 kohm", Film{5e3, 5e3}}, {"50-2 kohm", Film{50e3, 2e3, 20.0}}};

/// All taxels have the law of the first one, of 10 N at the simulated rubber's resistance there.
void make_alike(touch::fusion::ForceNetworks& networks) {
  const std::size_t taxels = networks.taxel_count();
  const double siemens = 1.0 / learn::simulation::RubberOptions{}.resistance_at_10n_ohm;
  for (std::size_t k = 0; k < networks.parameters.size(); ++k) {
    networks.parameters[k] = networks.parameters[k / taxels * taxels];
  }
  networks.reference_siemens.assign(taxels, static_cast<float>(siemens));
  networks.gain.assign(taxels, 1.0F);
  const std::vector<double> typical(taxels, networks.unloaded.offset_siemens.front() + siemens);
  for (const LoadPoint& point : touch::fusion::load_points(networks, typical)) {
    if (point.share < 1.0) continue;
    networks.gain.assign(taxels, static_cast<float>(10.0 * point.share / point.newtons));
    break;
  }
}

touch::pipeline::Model model_under_film(std::size_t lines, const FilmCircuit& circuit, const NamedFilm& of) {
  ArrayDescription array = support::reference_array(lines, lines);
  array.readout.circuit = circuit.circuit;
  array.readout.idle_rows = circuit.idle_rows;
  array.readout.idle_columns = circuit.idle_columns;
  array.readout.film = of.film;
  if (circuit.has_offsets) {
    array.readout.amplifier_gain = 1e4;
    array.readout.column_switch_ohm.assign(lines, 50.0);
    array.readout.amplifier_offset_v.assign(lines, 1e-3);
  }
  touch::pipeline::Model model = random_model(array);
  make_alike(model.networks);
  return model;
}

/// A line for every circuit, without a film and with one, few taxels touched and all.
void register_films() {
  for (const FilmCircuit& circuit : kFilmCircuits) {
    for (const auto& [scene, touched] : {std::pair("multitouch", "few"), std::pair("uniform", "all")}) {
      for (long lines = 8; lines <= circuit.most_lines; lines *= 2) {
        for (const NamedFilm& film : kFilms) {
          const std::string name = std::string(circuit.name) + ", " + touched + "|" + film.name;
          benchmark::RegisterBenchmark(name.c_str(),
                                       [&circuit, &film, scene = scene](benchmark::State& state) {
                                         const auto size = static_cast<std::size_t>(state.range(0));
                                         measure_pipeline(state, model_under_film(size, circuit, film), scene);
                                       })
              ->Arg(lines)
              ->UseManualTime();
        }
      }
    }
  }
}

/// Of the forces that the networks give.
void memory_alone(benchmark::State& state) {
  const auto lines = static_cast<std::size_t>(state.range(0));
  touch::fusion::MaterialMemory memory(kLaw, lines * lines);
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

BENCHMARK(frame_counts_to_newtons)
    ->Name("frame: counts to newtons|dermis")
    ->Arg(8)
    ->Arg(16)
    ->Arg(32)
    ->Arg(64)
    ->UseManualTime();
BENCHMARK(frame_of_a_material_with_memory)
    ->Name("the same, with memory|dermis")
    ->Arg(8)
    ->Arg(16)
    ->Arg(32)
    ->Arg(64)
    ->UseManualTime();
BENCHMARK(memory_alone)->Name("memory of the material|dermis")->Arg(8)->Arg(16)->Arg(32)->Arg(64)->UseManualTime();

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  dermis::register_films();
  dermis::benchmarks::FrameTimesReporter reporter("one thread, double precision inversion, single precision networks");
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return dermis::benchmarks::write_rows("pipeline", reporter.rows()) ? 0 : 1;
}
