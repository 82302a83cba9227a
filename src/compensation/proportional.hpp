// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>

#include "dermis/compensation/crosstalk.hpp"

namespace dermis::compensation {

/// The circuit is unknown: readings are taken as proportional to conductance, with 1 S for the full supply.
class Proportional final : public CrosstalkInversion {
 public:
  [[nodiscard]] bool invert(std::span<const double> ratio, std::span<double> siemens) noexcept override {
    std::copy(ratio.begin(), ratio.end(), siemens.begin());
    return true;
  }
  [[nodiscard]] double siemens_per_ratio() const noexcept override { return 1.0; }
};

}  // namespace dermis::compensation
