// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/evaluation/contact_count.hpp"

#include "dermis/touch/frames/neighbours.hpp"

namespace dermis::learn::calibration {

std::size_t count_contacts(const std::vector<float>& known_newtons, std::size_t rows, std::size_t cols) {
  std::vector<bool> open(known_newtons.size());
  for (std::size_t taxel = 0; taxel < open.size(); ++taxel) open[taxel] = !(known_newtons[taxel] == 0.0F);
  std::size_t contacts = 0;
  std::vector<std::size_t> stack;
  for (std::size_t seed = 0; seed < open.size(); ++seed) {
    if (!open[seed]) continue;
    ++contacts;
    open[seed] = false;
    stack.push_back(seed);
    while (!stack.empty()) {
      const std::size_t taxel = stack.back();
      stack.pop_back();
      for (const std::size_t near : Neighbours(rows, cols, taxel)) {
        if (!open[near]) continue;
        open[near] = false;
        stack.push_back(near);
      }
    }
  }
  return contacts;
}

}  // namespace dermis::learn::calibration
