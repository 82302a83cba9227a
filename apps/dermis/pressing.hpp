// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// dermis describe --press: which channel is where.
struct PressingOptions {
  std::string source;
  std::string places;  ///< places.csv, or a grid as 6x9; empty: nothing is pressed.
  double pitch_mm = 10.0;
  std::string out;  ///< NAME.toml; empty: nothing is written.
  bool json = false;
};

/// Leads a person from place to place of a device, or finds the presses in a file.
[[nodiscard]] Status describe_pressing(const PressingOptions& options);

}  // namespace dermis::app
