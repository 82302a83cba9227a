// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "harness.hpp"

#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

namespace dermis::benchmarks {
namespace {

/// Cores that others may keep busy before it is said.
constexpr double kQuiet = 0.05;

double seconds_of(const std::function<void()>& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Cores that others kept busy on average since it was made: what to mistrust times for.
class OtherLoad {
 public:
  [[nodiscard]] double cores() const {
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    return std::max(0.0, (busy_seconds() - busy_ - (own_seconds() - own_)) / elapsed);
  }

 private:
  /// Of the whole machine, from the first line of /proc/stat: user, nice, system, idle, iowait, irq, softirq, steal.
  static double busy_seconds() {
    std::ifstream statistics("/proc/stat");
    std::string name;
    double ticks[8] = {};
    statistics >> name;
    for (double& value : ticks) statistics >> value;
    const double busy = ticks[0] + ticks[1] + ticks[2] + ticks[5] + ticks[6] + ticks[7];
    return busy / static_cast<double>(sysconf(_SC_CLK_TCK));
  }

  static double own_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
  }

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double busy_ = busy_seconds();
  double own_ = own_seconds();
};

/// Seconds of one step: the mean over as many as fill a sample, after one that is not timed.
double sample(const Entry& entry, const Work& work, const Effort& effort) {
  entry.engine->use_threads(work.threads);
  if (work.threads > 1) std::this_thread::sleep_for(std::chrono::duration<double>(effort.seconds_between));
  if (entry.run.limit_seconds) return entry.run.limit_seconds();
  const double once = seconds_of(entry.run.step);
  const int steps = std::max(1, static_cast<int>(std::lround(effort.seconds_a_sample / once)));
  return seconds_of([&] {
           for (int step = 0; step < steps; ++step) entry.run.step();
         }) /
         steps;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

void print_row(const nlohmann::ordered_json& row, const Run& run) {
  const auto times_faster =
      row.contains("times_faster") ? fmt::format("{:.2f}", row["times_faster"].get<double>()) : "";
  fmt::print("{:<22}{:>3}  {:<10}{:>10.3f} {:<3}{:>10.3f}{:>10}  {:<4}", row["work"].get<std::string>(),
             row["threads"].get<int>(), row["engine"].get<std::string>(), row["median"].get<double>(),
             row["unit"].get<std::string>(), row["fastest"].get<double>(), times_faster,
             row["checked"].get<bool>() ? "yes" : "NO");
  if (row.contains("deviation")) {
    fmt::print("{:.1e} of {:.0e}: {}", row["deviation"].get<double>(), row["tolerance"].get<double>(),
               row["compared"].get<std::string>());
  }
  for (const auto& [name, value] : run.figures) fmt::print("  {} {:.1e}", name, value);
  if (!run.note.empty()) fmt::print("  [{}]", run.note);
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace

Placement::Placement(int threads) {
  sched_getaffinity(0, sizeof before_, &before_);
  cpu_set_t taken;
  CPU_ZERO(&taken);
  for (int core = CPU_SETSIZE - 1; core >= 0 && CPU_COUNT(&taken) < threads; --core) {
    if (CPU_ISSET(core, &before_)) CPU_SET(core, &taken);
  }
  sched_setaffinity(0, sizeof taken, &taken);
}

Placement::~Placement() {
  sched_setaffinity(0, sizeof before_, &before_);
}

void print_header() {
  fmt::print("{:<22}{:>3}  {:<10}{:>10} {:<3}{:>10}{:>10}  {}\n", "work", "thr", "engine", "median", "", "fastest",
             "dermis x", "checked");
}

void measure(const Work& work, std::vector<Entry> entries, const Effort& effort, nlohmann::ordered_json& rows) {
  const OtherLoad others;
  std::vector<std::vector<double>> samples(entries.size());
  for (int round = 0; round < effort.rounds; ++round) {
    for (std::size_t k = 0; k < entries.size(); ++k) {
      samples[k].push_back(work.scale * sample(entries[k], work, effort));
    }
  }
  const double other_cores = others.cores();
  double dermis = 0.0;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    if (entries[k].engine->name() == "dermis") dermis = median(samples[k]);
  }
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const Run& run = entries[k].run;
    nlohmann::ordered_json row{{"work", work.name},
                               {"engine", entries[k].engine->name()},
                               {"threads", work.threads},
                               {"median", median(samples[k])},
                               {"unit", work.unit},
                               {"checked", run.check.passed()},
                               {"fastest", *std::min_element(samples[k].begin(), samples[k].end())},
                               {"rounds", effort.rounds},
                               {"other_cores", other_cores}};
    if (!run.check.what.empty()) {
      row["compared"] = run.check.what;
      row["deviation"] = run.check.deviation;
      row["tolerance"] = run.check.tolerance;
    }
    if (row["engine"] != "dermis" && dermis > 0.0) row["times_faster"] = row["median"].get<double>() / dermis;
    for (const auto& [name, value] : run.figures) row[name] = value;
    if (!run.note.empty()) row["note"] = run.note;
    print_row(row, run);
    rows.push_back(std::move(row));
  }
  if (other_cores > kQuiet) fmt::print("  disturbed: other programs kept {:.2f} cores busy meanwhile\n", other_cores);
}

}  // namespace dermis::benchmarks
