// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::calibration {

/// The Cramer-Rao bound of the forces of a frame. No unbiased estimator that knows the circuit and the material
/// scatters less under the noise of the ADC alone. For the conductances it is sigma_ratio sqrt(diag((J^T J)^-1)), J the
/// derivatives of the readings; the derivative of the networks carries it to newtons.
class NoiseBound {
 public:
  /// Empty where the circuit is unknown, or too large for it: above kMostTaxels.
  static std::optional<NoiseBound> create(const touch::pipeline::Model& model);

  /// Frames for which the bound can be had in about a second.
  [[nodiscard]] std::size_t affordable_frames() const;

  /// The bound of every taxel [N]: of `conductance`, each of whose readings had the noise sigma_ratio.
  [[nodiscard]] std::vector<float> newtons(const ConductanceFrame& conductance, double sigma_ratio);

  static constexpr std::size_t kMostTaxels = 1024;

 private:
  NoiseBound(touch::compensation::CircuitModel circuit, touch::fusion::ForceNetworks networks);
  touch::compensation::CircuitModel circuit_;
  std::size_t taxels_;
  touch::fusion::ForceFusion fusion_;
};

}  // namespace dermis::learn::calibration
