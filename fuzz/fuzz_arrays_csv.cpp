// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>

#include "dermis/learn/recognition/dataset.hpp"
#include "fuzz_table.hpp"

// Arrays that pass the layout lie within a frame and do not overlap more than it holds.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto table = dermis::fuzz::table_of(data, size);
  if (!table) return 0;
  auto arrays = dermis::learn::recognition::arrays_of(*table);
  if (!arrays) {
    dermis::fuzz::check_error(arrays.error());
    return 0;
  }
  const dermis::learn::recognition::Layout layout{.arrays = *std::move(arrays), .readings = 4096};
  if (!layout.validate()) return 0;
  std::size_t taxels = 0;
  for (const auto& array : layout.arrays) {
    if (array.first_column + array.taxel_count() > layout.readings) std::abort();
    taxels += array.taxel_count();
  }
  if (taxels > layout.readings) std::abort();
  return 0;
}
