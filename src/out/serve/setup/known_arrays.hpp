// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// An array that was described or calibrated before.
struct KnownArray {
  std::string file;  ///< In the current folder: its newest model, or without one its newest array.toml.
  ArrayDescription array;
  bool is_calibrated = false;
};

/// The arrays of the newest 100 models and descriptions in the current folder, the newest first, one of each name.
[[nodiscard]] std::vector<KnownArray> known_arrays();

/// One of known_arrays(). Fails on all other files.
[[nodiscard]] Result<KnownArray> known_array(const std::string& file);

}  // namespace dermis::out::serve
