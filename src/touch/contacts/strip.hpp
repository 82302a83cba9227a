// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::touch::contacts {

/// Pitch along a strip, an array of one row or one column of several taxels [m]; empty for other arrays.
[[nodiscard]] inline std::optional<double> strip_pitch_m(const ArrayDescription& array) noexcept {
  if (array.rows == 1 && array.cols > 1) return array.col_pitch_m;
  if (array.cols == 1 && array.rows > 1) return array.row_pitch_m;
  return std::nullopt;
}

}  // namespace dermis::touch::contacts
