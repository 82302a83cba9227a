// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The crosstalk inversion and the forward solution of the grounded divider beside Eigen and plain loops, on one core.
// Usage: compensation_benchmark [--quick], which runs all only to see that it works.
#include <fmt/core.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compensation/frames.hpp"
#include "compensation/methods.hpp"
#include "compensation/peers.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "rows.hpp"
#include "support/reference_array.hpp"

namespace dermis::benchmarks {
namespace {

using Frames = std::vector<std::vector<double>>;

void pin_to_last_core() {
  cpu_set_t allowed;
  sched_getaffinity(0, sizeof allowed, &allowed);
  int last = 0;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &allowed)) last = core;
  }
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(last, &one);
  sched_setaffinity(0, sizeof one, &one);
}

/// An engine at one work: frame(k) is timed; deviation() says how far the result of the last frame is from the
/// reference.
struct Contestant {
  std::string engine;
  std::function<void(std::size_t)> frame;
  std::function<double(std::size_t)> deviation;
};

double percentile(std::vector<double>& values, double share) {
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

class Program {
 public:
  explicit Program(bool quick) : rounds_(quick ? 1 : 15) {}

  [[nodiscard]] bool run() {
    fmt::print("{:<22}{:<12}{:>10}{:>10}  {}\n", "work", "engine", "p50 us", "p99 us", "checked");
    const bool quick = rounds_ == 1;
    invert("invert_16x16_warm", 16, quick ? 20 : 400, true);
    invert("invert_16x16_cold", 16, quick ? 20 : 400, false);
    invert("invert_32x32_warm", 32, quick ? 10 : 200, true);
    invert("invert_64x64_warm", 64, quick ? 5 : 100, true);
    forward<float>("forward_16x16_float", 1e-5);
    forward<double>("forward_16x16_double", 1e-11);
    print_methods(quick ? 2 : 100);
    return write_rows("compensation", rows_);
  }

 private:
  /// Engines in turn, round after round, each through all frames; the median over all frames of all rounds.
  void measure(const std::string& work, const std::vector<Contestant>& entries, std::size_t frames, double tolerance) {
    std::vector<std::vector<double>> times_us(entries.size());
    std::vector<double> deviation(entries.size(), 0.0);
    for (int round = 0; round <= rounds_; ++round) {
      for (std::size_t e = 0; e < entries.size(); ++e) {
        for (std::size_t k = 0; k < frames; ++k) {
          const auto begin = std::chrono::steady_clock::now();
          entries[e].frame(k);
          const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - begin;
          if (round > 0) {
            times_us[e].push_back(elapsed.count());
          } else {
            deviation[e] = std::max(deviation[e], entries[e].deviation(k));
          }
        }
      }
    }
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const bool checked = deviation[e] <= tolerance;
      const double p50 = percentile(times_us[e], 0.5);
      const double p99 = percentile(times_us[e], 0.99);
      fmt::print("{:<22}{:<12}{:>10.3f}{:>10.3f}  {} {:.1e} of {:.1e}\n", work, entries[e].engine, p50, p99,
                 checked ? "yes" : "NO", deviation[e], tolerance);
      rows_.push_back({{"work", work},
                       {"engine", entries[e].engine},
                       {"threads", 1},
                       {"median", p50},
                       {"unit", "us"},
                       {"checked", checked},
                       {"p99", p99},
                       {"deviation", deviation[e]},
                       {"tolerance", tolerance}});
    }
  }

  /// Checked by the forward solution of Eigen in double: no reading is missed by more than 0.01 count, but for those of
  /// taxels at 0 S, which may lie below.
  void invert(const std::string& work, std::size_t size, std::size_t frame_count, bool warm) {
    const ArrayDescription array = support::reference_circuit(size, size);
    const Frames frames = touch_sequence(array, frame_count);
    const double tolerance = 0.01 / array.readout.full_scale_counts();
    const auto judge = eigen_peer(array);
    const auto misfit = [&](std::size_t k, const std::vector<double>& siemens) {
      std::vector<double> ratio(siemens.size());
      judge->forward(std::span<const double>(siemens), std::span<double>(ratio));
      double worst = 0.0;
      for (std::size_t t = 0; t < ratio.size(); ++t) {
        if (siemens[t] > 0.0 || frames[k][t] > ratio[t]) worst = std::max(worst, std::abs(frames[k][t] - ratio[t]));
      }
      return worst;
    };
    std::vector<double> ours(array.taxel_count());
    auto inversion = touch::compensation::make_crosstalk_inversion(array);
    std::vector<Contestant> entries = {{"dermis",
                                        [&](std::size_t k) {
                                          if (!warm) (*inversion)->forget();
                                          (void)(*inversion)->invert(frames[k], ours);
                                        },
                                        [&](std::size_t k) { return misfit(k, ours); }}};
    const auto eigen = eigen_peer(array);
    const auto scalar = scalar_peer(array);
    std::vector<std::vector<double>> theirs(2, std::vector<double>(array.taxel_count(), 0.0));
    const auto compete = [&](Peer& peer, std::vector<double>& siemens) {
      entries.push_back({peer.name(),
                         [&, warm, tolerance](std::size_t k) {
                           if (!warm || k == 0) peer.start(frames[k], siemens);
                           peer.invert(frames[k], tolerance, siemens);
                         },
                         [&](std::size_t k) { return misfit(k, siemens); }});
    };
    compete(*eigen, theirs[0]);
    compete(*scalar, theirs[1]);
    measure(work, entries, frame_count, tolerance + 1e-12);
  }

  /// Checked against the forward solution of Eigen in double, relative to each reading.
  template <typename Real>
  void forward(const std::string& work, double tolerance) {
    const ArrayDescription array = support::reference_circuit();
    const auto circuit = learn::simulation::ReadoutCircuit::create(array);
    const auto eigen = eigen_peer(array);
    const auto scalar = scalar_peer(array);
    std::vector<std::vector<Real>> siemens;
    auto inversion = touch::compensation::make_crosstalk_inversion(array);
    for (const std::vector<double>& ratio : touch_sequence(array, 100)) {
      std::vector<double> exact(ratio.size());
      (void)(*inversion)->invert(ratio, exact);
      siemens.emplace_back(exact.begin(), exact.end());
    }
    std::vector<Real> readings(array.taxel_count());
    const auto deviation = [&](std::size_t k) {
      const std::vector<double> exact(siemens[k].begin(), siemens[k].end());
      std::vector<double> reference(exact.size());
      eigen->forward(std::span<const double>(exact), std::span<double>(reference));
      double worst = 0.0;
      for (std::size_t t = 0; t < exact.size(); ++t) {
        worst = std::max(worst, std::abs(static_cast<double>(readings[t]) / reference[t] - 1.0));
      }
      return worst;
    };
    const auto run_peer = [&](Peer& peer) {
      return [&](std::size_t k) { peer.forward(std::span<const Real>(siemens[k]), std::span<Real>(readings)); };
    };
    measure(work,
            {{"dermis", [&](std::size_t k) { circuit->ratios(siemens[k], readings); }, deviation},
             {"eigen_ldlt", run_peer(*eigen), deviation},
             {"scalar", run_peer(*scalar), deviation}},
            siemens.size(), tolerance);
  }

  int rounds_;
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

}  // namespace
}  // namespace dermis::benchmarks

int main(int argc, char** argv) {
  dermis::benchmarks::pin_to_last_core();
  return dermis::benchmarks::Program(argc > 1 && std::string(argv[1]) == "--quick").run() ? 0 : 1;
}
