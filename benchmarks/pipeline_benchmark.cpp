// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Time of one frame, one thread: the whole pipeline (counts -> newtons) and the crosstalk inversion alone, beside the
// same fixed point written with Eigen. Frames are those of the simulator's multitouch scene; the networks have random
// parameters, as their values do not change the time.
#include <benchmark/benchmark.h>
#include <fmt/core.h>

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "dermis/compensation/crosstalk.hpp"
#include "dermis/pipeline/pipeline.hpp"
#include "dermis/simulation/simulator.hpp"
#include "rows.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_networks.hpp"

namespace dermis {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
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
    checked = checked && !has(force.status, FrameStatus::rejected | FrameStatus::not_converged);
  });
  state.counters["checked"] = checked ? 1 : 0;
}

/// Formula (4) of research/literature.md A.5 with Eigen's matrix products.
int invert_with_eigen(const ArrayDescription& array, const Matrix& ratio, Matrix& siemens) {
  const auto& readout = array.readout;
  const double tolerance = 0.01 / readout.full_scale_counts();
  const Eigen::Map<const Eigen::VectorXd> drive(readout.drive_ohm.data(), ratio.rows());
  const Eigen::RowVectorXd load =
      Eigen::Map<const Eigen::RowVectorXd>(readout.load_ohm.data(), ratio.cols()).cwiseInverse();
  const Matrix weighted = drive.asDiagonal() * ratio;
  const Eigen::RowVectorXd start_share = ratio.colwise().sum();
  siemens = ratio * (load.array() / (1.0 - start_share.array())).matrix().asDiagonal();
  for (int step = 1;; ++step) {
    const Eigen::VectorXd line_gain = 1.0 + drive.array() * siemens.rowwise().sum().array();
    const Eigen::VectorXd column = (load + siemens.colwise().sum()).transpose();
    const Matrix coupling = column.cwiseInverse().asDiagonal() * (siemens.transpose() * weighted);
    const Matrix undriven = line_gain.asDiagonal() * ratio - siemens * coupling;
    const Eigen::RowVectorXd scale = load.array() / (1.0 - undriven.colwise().sum().array());
    const Matrix next = undriven * scale.asDiagonal();
    const double change = ((next - siemens) * scale.cwiseInverse().asDiagonal()).cwiseAbs().maxCoeff();
    siemens = next;
    if (change <= tolerance || step == 200) return step;
  }
}

struct InversionInput {
  ArrayDescription array;
  std::vector<ConditionedFrame> frames;
};

InversionInput conditioned_frames(std::size_t lines) {
  InversionInput input{square_array(lines), std::vector<ConditionedFrame>(kFrames)};
  preprocessing::Conditioner conditioner(input.array);
  const std::vector<RawFrame> raw = multitouch_frames(input.array);
  for (std::size_t k = 0; k < kFrames; ++k) conditioner.process(raw[k], input.frames[k]);
  return input;
}

void crosstalk_inversion(benchmark::State& state) {
  const InversionInput input = conditioned_frames(static_cast<std::size_t>(state.range(0)));
  auto inversion = compensation::make_crosstalk_inversion(input.array);
  std::vector<double> siemens(input.array.taxel_count());
  bool checked = true;
  Matrix reference;
  for (const ConditionedFrame& frame : input.frames) {
    const Eigen::Map<const Matrix> ratio(frame.ratio.data(), state.range(0), state.range(0));
    invert_with_eigen(input.array, ratio, reference);
    checked = checked && (*inversion)->invert(frame.ratio, siemens).solved;
    const Eigen::Map<const Matrix> ours(siemens.data(), state.range(0), state.range(0));
    checked = checked && (ours - reference).cwiseAbs().maxCoeff() <= 1e-6 * reference.cwiseAbs().maxCoeff();
  }
  measure_frames(
      state, [&](std::size_t k) { benchmark::DoNotOptimize((*inversion)->invert(input.frames[k].ratio, siemens)); });
  state.counters["checked"] = checked ? 1 : 0;
}

void crosstalk_inversion_eigen(benchmark::State& state) {
  const InversionInput input = conditioned_frames(static_cast<std::size_t>(state.range(0)));
  Matrix siemens;
  measure_frames(state, [&](std::size_t k) {
    const Eigen::Map<const Matrix> ratio(input.frames[k].ratio.data(), state.range(0), state.range(0));
    benchmark::DoNotOptimize(invert_with_eigen(input.array, ratio, siemens));
  });
  state.counters["checked"] = 1;
}

BENCHMARK(frame_counts_to_newtons)->Name("frame: counts to newtons|dermis")->Arg(16)->Arg(32)->UseManualTime();
BENCHMARK(crosstalk_inversion)->Name("crosstalk inversion|dermis")->Arg(16)->Arg(32)->UseManualTime();
BENCHMARK(crosstalk_inversion_eigen)->Name("crosstalk inversion|eigen")->Arg(16)->Arg(32)->UseManualTime();

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
