// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <benchmark/benchmark.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/allocation_guard.hpp"

/// Times of single frames, for the benchmarks of what is done with each.
namespace dermis::benchmarks {

/// Runs process(k) over the frames, again and again, and reports the time of single frames and the allocations per
/// frame.
template <typename Process>
void measure_frames(benchmark::State& state, std::size_t frames, Process process) {
  using Clock = std::chrono::steady_clock;
  for (std::size_t k = 0; k < frames; ++k) process(k);
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
    k = (k + 1) % frames;
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

/// Prints a line a benchmark of measure_frames(), named "work|engine", and keeps the rows of the JSON file.
class FrameTimesReporter final : public benchmark::BenchmarkReporter {
 public:
  /// `note`: what all lines have in common.
  explicit FrameTimesReporter(const char* note) : note_(note) {}

  bool ReportContext(const Context&) override {
    fmt::print("{}\n", note_);
    fmt::print("{:<30}{:<10}{:<8}{:>10}{:>10}{:>10}{:>14}{:>9}\n", "work", "engine", "array", "p50 us", "p99 us",
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
    const std::string array = size_of(run.run_name.args);
    const auto counter = [&](const char* key) { return run.counters.at(key).value; };
    fmt::print("{:<30}{:<10}{:<8}{:>10.2f}{:>10.2f}{:>10.1f}{:>14.2f}{:>9}\n", work, engine, array, counter("p50_us"),
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

  /// "16" and "16/16" are both 16x16.
  static std::string size_of(const std::string& arguments) {
    const std::size_t slash = arguments.find('/');
    return arguments.substr(0, slash) + "x" + arguments.substr(slash == std::string::npos ? 0 : slash + 1);
  }

  const char* note_;
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

}  // namespace dermis::benchmarks
