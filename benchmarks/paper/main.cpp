// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// The BP engine beside its peers and beside what the machine can do at most. Usage:
//   network_benchmark [--quick] [work ...]
// Without works: all. --quick runs each only to see that it works, on a small bank; its times mean nothing.
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "harness.hpp"
#include "rows.hpp"

namespace dermis::benchmarks {
namespace {

constexpr const char* kTunables = "GLIBC_TUNABLES";
constexpr const char* kHugePages = "glibc.malloc.hugetlb=1";

/// dermis keeps its banks in huge pages; so that all engines have them, malloc must give them, and that is settled when
/// a process starts.
void restart_with_huge_pages(char** arguments) {
  const char* tunables = std::getenv(kTunables);
  if (tunables != nullptr && std::string(tunables).find("hugetlb") != std::string::npos) return;
  setenv(kTunables, kHugePages, 1);
  execv("/proc/self/exe", arguments);
  fmt::print(stderr, "network_benchmark: cannot restart itself: the peers have no huge pages\n");
}

std::string processor() {
  std::ifstream information("/proc/cpuinfo");
  for (std::string line; std::getline(information, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

struct Options {
  bool quick = false;
  std::vector<std::string> works;

  [[nodiscard]] bool wants(const std::string& work) const {
    return works.empty() || std::find(works.begin(), works.end(), work) != works.end();
  }
};

class Program {
 public:
  explicit Program(Options options)
      : options_(std::move(options)), cores_(static_cast<int>(std::thread::hardware_concurrency())) {
    engines_.push_back(dermis_engine());
#ifdef DERMIS_WITH_LIBTORCH
    engines_.push_back(libtorch_engine());
#else
    missing_.emplace_back("libtorch");
#endif
#ifdef DERMIS_WITH_FANN
    engines_.push_back(fann_engine());
#else
    missing_.emplace_back("fann");
#endif
    engines_.push_back(eigen_engine());
#ifdef DERMIS_WITH_OPENBLAS
    engines_.push_back(openblas_engine());
#else
    missing_.emplace_back("openblas");
#endif
    engines_.push_back(machine_limit());
  }

  bool run() {
    print_conditions();
    print_header();
    peaks();
    taxels();
    bank();
    for (const std::string& name : options_.works) {
      const auto is_named = [&](const auto& row) { return row["work"] == name; };
      if (std::none_of(rows_.begin(), rows_.end(), is_named)) {
        fmt::print(stderr, "network_benchmark: there is no work '{}'\n", name);
        return false;
      }
    }
    return write_rows("network", rows_);
  }

 private:
  void print_conditions() const {
    fmt::print("{}, {} cores; {} {}; {}={}\n", processor(), cores_, DERMIS_COMPILER, __VERSION__, kTunables,
               std::getenv(kTunables));
    for (const auto& engine : engines_) fmt::print("  {:<10}{}\n", engine->name(), engine->version());
    for (const std::string& name : missing_)
      fmt::print("  {:<10}not installed: left out (scripts/setup bench)\n", name);
    fmt::print("one thread: pinned to one core; engines in turn, {} rounds; median and fastest of a round\n\n",
               effort().rounds);
  }

  void peaks() {
    for (const std::size_t hidden : {5U, 20U}) {
      const std::string suffix = fmt::format("_2_{}_1", hidden);
      const PeaksProblem problem = peaks_problem(hidden, options_.quick ? 2 : 200);
      compete({"peaks_epoch" + suffix, 1, "us", 1e6 / static_cast<double>(problem.epochs)},
              [&](Engine& engine) { return engine.peaks_epoch(problem); });
      compete({"lm_step" + suffix, 1, "us", 1e6},
              [&](Engine& engine) { return engine.levenberg_marquardt_step(problem); });
    }
  }

  void taxels() {
    const TaxelProblem problem = taxel_problem(10'240);
    compete({"taxel_mlp_8_16_16_1", 1, "ns", 1e9 / static_cast<double>(problem.taxels())},
            [&](Engine& engine) { return engine.taxel_mlp(problem); });
  }

  void bank() {
    const BankProblem problem = options_.quick ? bank_problem(64, 8) : bank_problem(256, 256);
    for (int threads = 1; threads <= std::min(cores_, 2); ++threads) {
      const auto compete_on_bank = [&](const std::string& name, auto&& prepare) {
        compete({name, threads, "ms", 1e3}, prepare);
      };
      compete_on_bank("bank_frame", [&](Engine& engine) { return engine.bank_frame(problem); });
      compete_on_bank("bank_batch64", [&](Engine& engine) { return engine.bank_batch(problem); });
      compete_on_bank("bank_train_sgd",
                      [&](Engine& engine) { return engine.bank_training(problem, Rule::gradient_descent); });
      compete_on_bank("bank_train_adam", [&](Engine& engine) { return engine.bank_training(problem, Rule::adam); });
    }
  }

  template <typename Prepare>
  void compete(const Work& work, Prepare prepare) {
    if (!options_.wants(work.name)) return;
    const Placement placement(work.threads);
    std::vector<Entry> entries;
    for (const auto& engine : engines_) {
      engine->use_threads(work.threads);
      if (std::optional<Run> run = prepare(*engine)) entries.push_back({engine.get(), std::move(*run)});
    }
    measure(work, std::move(entries), effort(), rows_);
  }

  [[nodiscard]] Effort effort() const { return options_.quick ? Effort{1, 0.0, 0.0} : Effort{}; }

  Options options_;
  int cores_;
  std::vector<std::unique_ptr<Engine>> engines_;
  std::vector<std::string> missing_;
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

}  // namespace
}  // namespace dermis::benchmarks

int main(int argc, char** argv) {
  dermis::benchmarks::restart_with_huge_pages(argv);
  dermis::benchmarks::Options options;
  for (int k = 1; k < argc; ++k) {
    if (std::string(argv[k]) == "--quick") {
      options.quick = true;
    } else {
      options.works.emplace_back(argv[k]);
    }
  }
  return dermis::benchmarks::Program(options).run() ? 0 : 1;
}
