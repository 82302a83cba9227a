// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace dermis::support {

/// matrix^-1 right by Gauss-Jordan elimination with pivoting: `matrix` [size, size] and `right` [size, columns] are
/// row-major. Slow and plain, so that it shares nothing with what it judges.
inline std::vector<double> solve(std::vector<double> matrix, std::vector<double> right, std::size_t size) {
  const std::size_t columns = right.size() / size;
  for (std::size_t k = 0; k < size; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < size; ++i) {
      if (std::abs(matrix[i * size + k]) > std::abs(matrix[pivot * size + k])) pivot = i;
    }
    for (std::size_t j = 0; j < size; ++j) std::swap(matrix[k * size + j], matrix[pivot * size + j]);
    for (std::size_t j = 0; j < columns; ++j) std::swap(right[k * columns + j], right[pivot * columns + j]);
    for (std::size_t i = 0; i < size; ++i) {
      const double factor = matrix[i * size + k] / matrix[k * size + k];
      if (i == k || factor == 0.0) continue;
      for (std::size_t j = k; j < size; ++j) matrix[i * size + j] -= factor * matrix[k * size + j];
      for (std::size_t j = 0; j < columns; ++j) right[i * columns + j] -= factor * right[k * columns + j];
    }
  }
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < columns; ++j) right[i * columns + j] /= matrix[i * size + i];
  }
  return right;
}

}  // namespace dermis::support
