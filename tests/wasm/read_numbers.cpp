// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Usage: read_numbers <lines >numbers
// Of each line: how many characters are its number, and the number, as double and as float.
#include <cstddef>
#include <cstdio>
#include <iostream>
#include <string>

#include "dermis/bytes/files/numbers.hpp"

int main() {
  for (std::string line; std::getline(std::cin, line);) {
    double whole = 7.0;
    float half = 7.0F;
    const std::size_t of_whole = dermis::bytes::files::number_at(line, whole);
    const std::size_t of_half = dermis::bytes::files::number_at(line, half);
    std::printf("'%s' %zu %.17g %zu %.9g\n", line.c_str(), of_whole, whole, of_half, static_cast<double>(half));
  }
  return 0;
}
