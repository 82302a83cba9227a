// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <string_view>
#include <vector>

#include "check_error.hpp"
#include "dermis/live/buses/register_map.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace buses = dermis::live::buses;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto map = buses::register_map_from_toml(text, "map.toml");
  if (!map) {
    dermis::fuzz::check_line(map.error());
    return 0;
  }
  std::vector<std::size_t> all(map->arrays.size());
  std::iota(all.begin(), all.end(), 0U);
  std::size_t words = 0;
  for (const buses::RegisterRead& read : buses::plan_reads(*map, all)) {
    if (read.words < 1 || read.words > 125) std::abort();
    words += read.words;
  }
  for (const buses::RegisterArray& array : map->arrays) words -= array.words();
  if (words != 0) std::abort();
  return 0;
}
