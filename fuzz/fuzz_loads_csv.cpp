// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <sstream>

#include "check_error.hpp"
#include "dermis/bytes/files/loads_csv.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  dermis::ArrayDescription array;
  array.rows = 4;
  array.cols = 3;
  array.taxel_area_m2 = 1e-4;
  constexpr std::size_t kFrames = 10;
  std::istringstream bytes(std::string(reinterpret_cast<const char*>(data), size));
  const auto loads = dermis::bytes::files::read_loads(bytes, "fuzz", array, kFrames);
  if (!loads) {
    dermis::fuzz::check_error(loads.error());
    return 0;
  }
  for (const dermis::Load& load : *loads) {
    const bool is_inside = load.where.last_row < array.rows && load.where.last_col < array.cols;
    if (!is_inside || load.frame >= kFrames || !(load.value >= 0.0)) std::abort();
  }
  return 0;
}
