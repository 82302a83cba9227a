// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <sched.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine.hpp"

namespace dermis::benchmarks {

/// A work in one row block of the table.
struct Work {
  std::string name;
  int threads = 1;
  std::string unit;    ///< "us", "ms" or "ns"
  double scale = 1.0;  ///< From the seconds of one step to the unit.
};

/// How long to measure.
struct Effort {
  int rounds = 9;
  double seconds_a_sample = 0.05;
  double seconds_between = 0.05;  ///< With several threads: until the pools of the others have gone to sleep.
};

/// An engine and its run of the work at hand.
struct Entry {
  Engine* engine = nullptr;
  Run run;
};

/// While it lives, this thread and those that it begins run on so many of its cores, the last ones.
class Placement {
 public:
  explicit Placement(int threads);
  Placement(const Placement&) = delete;
  Placement& operator=(const Placement&) = delete;
  ~Placement();

 private:
  cpu_set_t before_{};
};

/// Times the engines in turn, round after round, so that they all meet the same moods of the machine; prints their
/// medians and appends them to `rows`.
void measure(const Work& work, std::vector<Entry> entries, const Effort& effort, nlohmann::ordered_json& rows);

void print_header();

}  // namespace dermis::benchmarks
