// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace dermis::touch::compensation {

/// The inverse of a square matrix by Gauss-Jordan elimination of blocks, each a matrix product. Pivots are sought
/// within a block only, which suits well-conditioned matrices of unit diagonal.
class DenseInverse {
 public:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  explicit DenseInverse(std::size_t size);

  [[nodiscard]] Matrix& matrix() noexcept { return matrix_; }

  /// Puts the inverse in the place of matrix(). Allocates nothing. A singular matrix gives values that are not finite.
  void invert() noexcept;

 private:
  static constexpr Eigen::Index kBlock = 32;

  Matrix matrix_;
  Matrix product_;  // [size, size]
  Matrix left_;     // [size, kBlock]
  Matrix right_;    // [kBlock, size]
  Matrix pivot_;    // [kBlock, kBlock]
};

}  // namespace dermis::touch::compensation
