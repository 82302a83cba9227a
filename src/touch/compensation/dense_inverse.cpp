// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/dense_inverse.hpp"

#include <algorithm>

#include "touch/compensation/matrix_product.hpp"

namespace dermis::touch::compensation {
namespace {

using Block = Eigen::Block<DenseInverse::Matrix>;

/// Gauss-Jordan elimination in place, with row exchanges that are undone as column exchanges of the inverse.
void invert_block(Block block) {
  constexpr Eigen::Index kMostRows = 64;
  Eigen::Index pivots[kMostRows];
  for (Eigen::Index k = 0; k < block.rows(); ++k) {
    Eigen::Index pivot = 0;
    block.col(k).tail(block.rows() - k).cwiseAbs().maxCoeff(&pivot);
    pivots[k] = k + pivot;
    if (pivot != 0) block.row(k).swap(block.row(pivots[k]));
    const double inverse = 1.0 / block(k, k);
    block(k, k) = 1.0;
    block.row(k) *= inverse;
    for (Eigen::Index i = 0; i < block.rows(); ++i) {
      if (i == k) continue;
      const double factor = block(i, k);
      block(i, k) = 0.0;
      block.row(i) -= factor * block.row(k);
    }
  }
  for (Eigen::Index k = block.rows(); k-- > 0;) {
    if (pivots[k] != k) block.col(k).swap(block.col(pivots[k]));
  }
}

}  // namespace

DenseInverse::DenseInverse(std::size_t size)
    : matrix_(static_cast<Eigen::Index>(size), static_cast<Eigen::Index>(size)),
      product_(matrix_.rows(), matrix_.cols()),
      left_(matrix_.rows(), kBlock),
      right_(kBlock, matrix_.cols()),
      pivot_(kBlock, kBlock) {}

void DenseInverse::invert() noexcept {
  const auto size = static_cast<std::size_t>(matrix_.rows());
  for (Eigen::Index first = 0; first < matrix_.rows(); first += kBlock) {
    const Eigen::Index rows = std::min(kBlock, matrix_.rows() - first);
    const auto count = static_cast<std::size_t>(rows);
    auto pivot = pivot_.block(0, 0, rows, rows);
    pivot = matrix_.block(first, first, rows, rows);
    invert_block(pivot);
    left_.leftCols(rows) = matrix_.middleCols(first, rows);
    left_.middleRows(first, rows).setZero();
    multiply(StridedMatrix<double>{pivot_.data(), static_cast<std::size_t>(kBlock), 1},
             matrix_.data() + first * matrix_.cols(), count, count, size, right_.data());
    right_.block(0, first, rows, rows) = pivot;
    matrix_.middleCols(first, rows).setZero();
    matrix_.middleRows(first, rows) = right_.topRows(rows);
    multiply(StridedMatrix<double>{left_.data(), static_cast<std::size_t>(kBlock), 1}, right_.data(), size, count, size,
             product_.data());
    matrix_ -= product_;
  }
}

}  // namespace dermis::touch::compensation
