// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/circuit_model/drop_pairs.hpp"

#include "touch/compensation/matrix_product.hpp"

namespace dermis::touch::compensation {

DropPairs::DropPairs(std::size_t driven, std::size_t sensed, std::size_t taxels)
    : forward(at(driven), at(taxels)),
      adjoint(at(sensed), at(taxels)),
      adjoint_by_taxel_(at(taxels), at(sensed)),
      weighted_(at(driven), at(taxels)),
      sums_(at(driven), at(sensed)) {}

const Matrix& DropPairs::sum(std::span<const double> change) noexcept {
  const Eigen::Map<const Eigen::VectorXd> step(change.data(), at(change.size()));
  const auto rows = static_cast<std::size_t>(forward.rows());
  const auto cols = static_cast<std::size_t>(adjoint.rows());
  weighted_.noalias() = forward * step.asDiagonal();
  multiply(StridedMatrix<double>{weighted_.data(), change.size(), 1}, adjoint_by_taxel_.data(), rows, change.size(),
           cols, sums_.data());
  return sums_;
}

}  // namespace dermis::touch::compensation
