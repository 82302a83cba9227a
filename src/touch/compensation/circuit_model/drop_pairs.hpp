// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "touch/compensation/circuit_model/matrix.hpp"

namespace dermis::touch::compensation {

/// The drops at every taxel whose products are the derivatives of the currents: dI_ds/dg = -forward adjoint.
class DropPairs {
 public:
  DropPairs(std::size_t driven, std::size_t sensed, std::size_t taxels);

  Matrix forward;  ///< Of the scan [driven, taxels].
  Matrix adjoint;  ///< For 1 V at a sensed line [sensed, taxels].

  /// After a change of `adjoint`.
  void prepare_sums() noexcept { adjoint_by_taxel_ = adjoint.transpose(); }

  /// out = -factor forward_d adjoint_s for the taxels from `first` on.
  void derive(std::size_t driven, std::size_t sensed, double factor, std::size_t first,
              Eigen::Map<Eigen::RowVectorXd> out) const noexcept {
    const auto part = [&](const Matrix& drops, std::size_t line) {
      return drops.row(at(line)).segment(at(first), out.size());
    };
    out = -factor * part(forward, driven).cwiseProduct(part(adjoint, sensed));
  }

  /// Sums over the taxels of forward_d adjoint_s change [driven, sensed], all at once: one matrix product.
  const Matrix& sum(std::span<const double> change) noexcept;

 private:
  Matrix adjoint_by_taxel_;  // [taxels, sensed]
  Matrix weighted_;          // [driven, taxels]
  Matrix sums_;              // [driven, sensed]
};

}  // namespace dermis::touch::compensation
