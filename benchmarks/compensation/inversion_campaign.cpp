// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Inverts random arrays of every circuit and size (docs/reasons/inversions.md, "What readings determine"). Takes
// minutes. Usage: inversion_campaign [LARGEST]   (rows and columns of the largest arrays; 32)
#include "support/inversion_campaign.hpp"

#include <fmt/core.h>

#include <cstdlib>

int main(int argc, char** argv) {
  namespace support = dermis::support;
  const std::size_t largest = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 32;
  for (const support::NamedCircuit& circuit : support::all_circuits()) {
    for (const std::size_t size : {2U, 4U, 8U, 12U, 16U, 32U}) {
      if (size > largest) break;
      const support::Campaign campaign = support::campaign_of(circuit, size, size, size < 32 ? 100 : 5);
      fmt::print("{:<46} {:>2}x{:<2} returned {:>3}, two solutions {:>2}, failed {:>2}, largest error {:.1e}\n",
                 circuit.name, size, size, campaign.returned, campaign.ambiguous, campaign.failed, campaign.worst);
      std::fflush(stdout);
    }
  }
  return 0;
}
