// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/bytes/files/array_frames.hpp"

namespace dermis::bytes::files {

/// Two or three axes of an array.
struct ChosenArray {
  NumberArray array;
  bool is_told = false;  ///< The axes are frames, rows and columns.
};

/// By the words of hints.axes. Without any, axes of size 1 beyond three are left out.
[[nodiscard]] Result<ChosenArray> choose_axes(const NumberArray& array, const ArrayHints& hints);

}  // namespace dermis::bytes::files
