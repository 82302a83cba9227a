// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/any_reading.hpp"

#include <cstddef>
#include <cstdint>

#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::compensation {

DERMIS_PROCESSOR_CLONES bool any_is_above(std::span<const double> ratio, double least) noexcept {
  const double* const readings = ratio.data();
  std::uint64_t any = 0;
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) any |= readings[taxel] < least ? 0 : 1;
  return any != 0;
}

}  // namespace dermis::touch::compensation
