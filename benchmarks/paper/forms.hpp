// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace dermis::benchmarks {

/// One of several ways in which a peer can do the same work.
struct Form {
  std::string name;
  std::function<void()> body;
};

/// The fastest of them, as it is measured here, each at its best of several runs: what a peer enters the contest with.
inline Form fastest(const std::vector<Form>& forms) {
  const Form* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Form& form : forms) {
    for (int run = 0; run < 5; ++run) {
      const auto start = std::chrono::steady_clock::now();
      form.body();
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      if (seconds < least) best = &form;
      least = std::min(least, seconds);
    }
  }
  return *best;
}

}  // namespace dermis::benchmarks
