// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

namespace dermis::touch::compensation {

/// A read-only matrix of any layout: element (i, j) stands at data[i * row_stride + j * col_stride].
template <typename Real>
struct StridedMatrix {
  const Real* data;
  std::size_t row_stride;
  std::size_t col_stride;
};

/// out = a b: a [rows, inner], b [inner, cols] and out [rows, cols] row-major and dense; out overlaps neither.
/// SIMD over the columns (Highway, run-time dispatch).
void multiply(const StridedMatrix<double>& a, const double* b, std::size_t rows, std::size_t inner, std::size_t cols,
              double* out) noexcept;
void multiply(const StridedMatrix<float>& a, const float* b, std::size_t rows, std::size_t inner, std::size_t cols,
              float* out) noexcept;

}  // namespace dermis::touch::compensation
