// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cmath>

#include "dermis/touch/compensation/crosstalk.hpp"

namespace dermis::touch::compensation {

/// The circuit is unknown: readings are taken as proportional to conductance, with 1 S for the full supply.
class Proportional final : public CrosstalkInversion {
 public:
  [[nodiscard]] InversionResult invert(std::span<const double> ratio, std::span<double> siemens) noexcept override {
    bool finite = true;
    for (std::size_t k = 0; k < ratio.size(); ++k) {
      if (std::isnan(ratio[k])) continue;  // keeps its conductance
      finite = finite && std::isfinite(ratio[k]);
      siemens[k] = std::isfinite(ratio[k]) ? std::max(ratio[k], 0.0) : 0.0;
    }
    return {finite, 0.0};
  }
  void propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept override {
    std::fill(sigma_siemens.begin(), sigma_siemens.end(), sigma_ratio);
  }
  [[nodiscard]] double siemens_per_ratio() const noexcept override { return 1.0; }
};

}  // namespace dermis::touch::compensation
