// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Time of one frame, one thread, counts to newtons. Frames are those of the simulator's multitouch scene, each a touch
// of its own; the networks have random parameters, as their values do not change the time.
#include <benchmark/benchmark.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "dermis/pipeline/pipeline.hpp"
#include "dermis/simulation/simulator.hpp"
#include "rows.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_networks.hpp"

namespace dermis {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kFrames = 256;

ArrayDescription square_array(std::size_t lines) {
  ArrayDescription array;
  array.rows = lines;
  array.cols = lines;
  array.readout.drive_ohm.assign(lines, 20.0);
  array.readout.load_ohm.assign(lines, 200.0);
  array.readout.adc_reference_v = 5.0;
  array.readout.supply_v = 5.0;
  return array;
}

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
  model.networks.offset_siemens.assign(array.taxel_count(), 1.0 / simulation::RubberOptions{}.unloaded_ohm);
  return model;
}

/// Runs process(k) over the frames and reports the time of single frames and the allocations per frame.
template <typename Process>
void measure_frames(benchmark::State& state, Process process) {
  for (std::size_t k = 0; k < kFrames; ++k) process(k);
  std::vector<double> times;
  times.reserve(1U << 22U);
  std::size_t k = 0;
  const support::AllocationGuard guard;
  for (auto _ : state) {
    const auto start = Clock::now();
    process(k);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    state.SetIterationTime(seconds);
    if (times.size() < times.capacity()) times.push_back(seconds);
    k = (k + 1) % kFrames;
  }
  const auto allocated = static_cast<double>(guard.count());
  std::sort(times.begin(), times.end());
  const auto percentile_us = [&](double share) {
    return 1e6 * times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  state.counters["p50_us"] = percentile_us(0.50);
  state.counters["p99_us"] = percentile_us(0.99);
  state.counters["max_us"] = percentile_us(1.0);
  state.counters["allocations"] = allocated / static_cast<double>(state.iterations());
}

void frame_counts_to_newtons(benchmark::State& state) {
  const ArrayDescription array = square_array(static_cast<std::size_t>(state.range(0)));
  std::vector<RawFrame> frames = multitouch_frames(array);
  Nanos time{0};
  Result<pipeline::Pipeline> pipeline = pipeline::Pipeline::create(random_model(array));
  ForceFrame force;
  bool checked = true;
  measure_frames(state, [&](std::size_t k) {
    frames[k].time = time += std::chrono::milliseconds(1);
    pipeline->process(frames[k], force);
    benchmark::DoNotOptimize(force.newtons.data());
    checked =
        checked && !has(force.status, FrameStatus::rejected | FrameStatus::not_converged | FrameStatus::line_fault);
  });
  state.counters["checked"] = checked ? 1 : 0;
}

BENCHMARK(frame_counts_to_newtons)->Name("frame: counts to newtons|dermis")->Arg(16)->Arg(32)->UseManualTime();

/// Prints a line a benchmark and keeps the rows of the JSON file.
class TableReporter final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override {
    fmt::print("one thread, double precision inversion, single precision networks\n");
    fmt::print("{:<28}{:<10}{:<8}{:>10}{:>10}{:>10}{:>14}{:>9}\n", "work", "engine", "array", "p50 us", "p99 us",
               "max us", "allocations", "checked");
    return true;
  }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) report(run);
  }

  [[nodiscard]] const nlohmann::ordered_json& rows() const { return rows_; }

 private:
  void report(const Run& run) {
    const std::string& name = run.run_name.function_name;
    const std::string work = name.substr(0, name.find('|'));
    const std::string engine = name.substr(name.find('|') + 1);
    const std::string array = fmt::format("{0}x{0}", run.run_name.args);
    const auto counter = [&](const char* key) { return run.counters.at(key).value; };
    fmt::print("{:<28}{:<10}{:<8}{:>10.2f}{:>10.2f}{:>10.1f}{:>14.2f}{:>9}\n", work, engine, array, counter("p50_us"),
               counter("p99_us"), counter("max_us"), counter("allocations"), counter("checked") == 1.0 ? "yes" : "NO");
    rows_.push_back({{"work", work + ", " + array},
                     {"engine", engine},
                     {"threads", 1},
                     {"median", counter("p50_us")},
                     {"unit", "us"},
                     {"p99", counter("p99_us")},
                     {"max", counter("max_us")},
                     {"allocations", counter("allocations")},
                     {"checked", counter("checked") == 1.0}});
  }

  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  dermis::TableReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return dermis::benchmarks::write_rows("pipeline", reporter.rows()) ? 0 : 1;
}
