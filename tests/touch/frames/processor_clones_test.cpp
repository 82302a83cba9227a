// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/processor_clones.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace dermis {
namespace {

DERMIS_PROCESSOR_CLONES void add_half_of_each(const std::vector<double>& from, std::vector<double>& to) {
  for (std::size_t k = 0; k < to.size(); ++k) to[k] += 0.5 * from[k];
}

TEST(ProcessorClones, the_clone_for_this_processor_does_what_the_source_says) {
  std::vector<double> from(37);
  std::vector<double> to(37, 1.0);
  for (std::size_t k = 0; k < from.size(); ++k) from[k] = static_cast<double>(k);
  add_half_of_each(from, to);
  for (std::size_t k = 0; k < to.size(); ++k) EXPECT_EQ(to[k], 1.0 + 0.5 * static_cast<double>(k));
}

}  // namespace
}  // namespace dermis
