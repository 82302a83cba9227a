// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/core/result.hpp"

namespace dermis::app {

struct AdviseOptions {
  std::string array;
  std::vector<double> range_ohm;  ///< Least and greatest resistance of a taxel.
  bool json = false;
};

/// Prints which load and drive resistances give the smallest error.
[[nodiscard]] Status circuit_advise(const AdviseOptions& options);

}  // namespace dermis::app
