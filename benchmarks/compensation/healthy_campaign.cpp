// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Watches random arrays without a fault (docs/health.md, "How well"): healthy_campaign [ARRAYS [FRAMES [FIRST_SEED]]].
#include <fmt/core.h>

#include <cstdlib>

#include "support/healthy_arrays.hpp"

int main(int argc, char** argv) {
  namespace support = dermis::support;
  const auto argument = [&](int k, std::size_t otherwise) {
    return argc > k ? static_cast<std::size_t>(std::strtoull(argv[k], nullptr, 10)) : otherwise;
  };
  const std::size_t arrays = argument(1, 200);
  const std::size_t frames = argument(2, 2000);
  const std::size_t first_seed = argument(3, 1);
  std::size_t faulty = 0;
  for (std::size_t seed = first_seed; seed < first_seed + arrays; ++seed) {
    const support::HealthyArray healthy = support::random_healthy_array(seed);
    const std::string found = support::found_faults(healthy, frames);
    if (found.empty()) continue;
    ++faulty;
    fmt::print("seed {}, {}: {}\n", seed, healthy.words, found);
    std::fflush(stdout);
  }
  fmt::print("{} of {} healthy arrays have masked taxels\n", faulty, arrays);
  return faulty == 0 ? 0 : 1;
}
