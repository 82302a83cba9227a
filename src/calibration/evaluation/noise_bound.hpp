// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/compensation/circuit_model.hpp"
#include "dermis/fusion/force_fusion.hpp"
#include "dermis/pipeline/model.hpp"

namespace dermis::calibration {

/// The Cramer-Rao bound of the forces of a frame. No unbiased estimator that knows the circuit and the material
/// scatters less under the noise of the ADC alone. For the conductances it is sigma_ratio sqrt(diag((J^T J)^-1)), J the
/// derivatives of the readings; the derivative of the networks carries it to newtons.
class NoiseBound {
 public:
  /// Empty where the circuit is unknown, or too large for it: above kMostTaxels.
  static std::optional<NoiseBound> create(const pipeline::Model& model);

  /// Frames for which the bound can be had in about a second.
  [[nodiscard]] std::size_t affordable_frames() const;

  /// The bound of every taxel [N]: of `conductance`, each of whose readings had the noise sigma_ratio.
  [[nodiscard]] std::vector<float> newtons(const ConductanceFrame& conductance, double sigma_ratio);

  static constexpr std::size_t kMostTaxels = 1024;

 private:
  NoiseBound(compensation::CircuitModel circuit, fusion::ForceNetworks networks);
  compensation::CircuitModel circuit_;
  std::size_t taxels_;
  fusion::ForceFusion fusion_;
};

}  // namespace dermis::calibration
