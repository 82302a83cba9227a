// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/contact_count.hpp"

#include <algorithm>

namespace dermis::calibration {

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
      const std::size_t row = stack.back() / cols;
      const std::size_t col = stack.back() % cols;
      stack.pop_back();
      for (std::size_t r = row == 0 ? 0 : row - 1; r <= std::min(row + 1, rows - 1); ++r) {
        for (std::size_t c = col == 0 ? 0 : col - 1; c <= std::min(col + 1, cols - 1); ++c) {
          if (!open[r * cols + c]) continue;
          open[r * cols + c] = false;
          stack.push_back(r * cols + c);
        }
      }
    }
  }
  return contacts;
}

}  // namespace dermis::calibration
