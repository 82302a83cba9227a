// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "dermis/touch/compensation/line_fault.hpp"
#include "dermis/touch/frames/axis.hpp"

namespace dermis::touch::compensation {

/// Visits the taxels that masked_taxel_count() counts.
template <typename Visit>
void for_each_masked_taxel(const LineFault& fault, const ArrayDescription& array, const Visit& visit) {
  const LineFaultTraits& traits = traits_of(fault.kind);
  if (silences_row(fault, array)) {
    for (std::size_t col = 0; col < array.cols; ++col) visit(array.index(fault.place / array.cols, col));
    return;
  }
  if (traits.scope == LineFaultScope::taxel) visit(fault.place);
  if (!traits.axis) return;
  const std::size_t lines = traits.scope == LineFaultScope::line_pair ? 2 : 1;
  for (std::size_t line = fault.place; line < fault.place + lines; ++line) {
    for (std::size_t k = 0; k < line_length(array, *traits.axis); ++k) {
      visit(taxel_on_line(array, *traits.axis, line, k));
    }
  }
}

}  // namespace dermis::touch::compensation
