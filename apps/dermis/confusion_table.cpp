// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "confusion_table.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace dermis::app {

void print_confusion(const std::vector<std::string>& names, const std::vector<std::size_t>& confusion) {
  constexpr std::size_t kMostClasses = 16;
  if (names.size() > kMostClasses) return;
  std::size_t widest = 5;
  for (const std::string& name : names) widest = std::max(widest, name.size());
  fmt::print("\n{:<{}}  answered (columns in the same order)\n", "class", widest);
  for (std::size_t row = 0; row < names.size(); ++row) {
    fmt::print("{:<{}} ", names[row], widest);
    for (std::size_t col = 0; col < names.size(); ++col) fmt::print("{:>5}", confusion[row * names.size() + col]);
    fmt::print("\n");
  }
}

}  // namespace dermis::app
