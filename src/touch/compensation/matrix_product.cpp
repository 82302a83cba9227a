// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/matrix_product.hpp"

#ifdef __wasm__
#define HWY_COMPILE_ONLY_EMU128  // Highway 1.0.3 has no vectors of double there
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "touch/compensation/matrix_product.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace dermis::touch::compensation::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Rows row ... row + Rows - 1 of the product, columns col ... col + 2 lanes(d) - 1 (or lanes(d), without `Pair`). They
/// are held in registers while the inner dimension goes by.
template <std::size_t Rows, bool Pair, class D, typename Real = hn::TFromD<D>>
HWY_INLINE void multiply_block(D d, const StridedMatrix<Real>& a, const Real* HWY_RESTRICT b, std::size_t row,
                               std::size_t col, std::size_t inner, std::size_t cols, Real* HWY_RESTRICT out) {
  const std::size_t lanes = hn::Lanes(d);
  hn::Vec<D> left[Rows];
  hn::Vec<D> right[Rows];
  for (std::size_t r = 0; r < Rows; ++r) left[r] = right[r] = hn::Zero(d);
  for (std::size_t l = 0; l < inner; ++l) {
    const Real* b_row = b + l * cols + col;
    const auto b_left = hn::LoadU(d, b_row);
    const auto b_right = Pair ? hn::LoadU(d, b_row + lanes) : b_left;
    for (std::size_t r = 0; r < Rows; ++r) {
      const auto factor = hn::Set(d, a.data[(row + r) * a.row_stride + l * a.col_stride]);
      left[r] = hn::MulAdd(factor, b_left, left[r]);
      if constexpr (Pair) right[r] = hn::MulAdd(factor, b_right, right[r]);
    }
  }
  for (std::size_t r = 0; r < Rows; ++r) {
    Real* out_row = out + (row + r) * cols + col;
    hn::StoreU(left[r], d, out_row);
    if constexpr (Pair) hn::StoreU(right[r], d, out_row + lanes);
  }
}

/// Pairs of whole vectors, then whole ones, halves of them, and single columns.
template <std::size_t Rows, typename Real>
HWY_INLINE void multiply_rows(const StridedMatrix<Real>& a, const Real* b, std::size_t row, std::size_t inner,
                              std::size_t cols, Real* out) {
  const hn::ScalableTag<Real> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t col = 0;
  for (; col + 2 * lanes <= cols; col += 2 * lanes) multiply_block<Rows, true>(d, a, b, row, col, inner, cols, out);
  for (; col + lanes <= cols; col += lanes) multiply_block<Rows, false>(d, a, b, row, col, inner, cols, out);
  const hn::CappedTag<Real, (hn::MaxLanes(d) + 1) / 2> half;
  for (; col + hn::Lanes(half) <= cols; col += hn::Lanes(half)) {
    multiply_block<Rows, false>(half, a, b, row, col, inner, cols, out);
  }
  const hn::CappedTag<Real, 1> one;
  for (; col < cols; ++col) multiply_block<Rows, false>(one, a, b, row, col, inner, cols, out);
}

template <typename Real>
HWY_INLINE void multiply_all(const StridedMatrix<Real>& a, const Real* b, std::size_t rows, std::size_t inner,
                             std::size_t cols, Real* out) {
  constexpr std::size_t kBlock = HWY_TARGET <= HWY_AVX3 ? 8 : 4;  // 32 registers hold twice the sums of 16
  std::size_t row = 0;
  for (; row + kBlock <= rows; row += kBlock) multiply_rows<kBlock>(a, b, row, inner, cols, out);
  for (; row + 4 <= rows; row += 4) multiply_rows<4>(a, b, row, inner, cols, out);
  for (; row < rows; ++row) multiply_rows<1>(a, b, row, inner, cols, out);
}

void multiply_double(const StridedMatrix<double>& a, const double* b, std::size_t rows, std::size_t inner,
                     std::size_t cols, double* out) {
  multiply_all(a, b, rows, inner, cols, out);
}

void multiply_single(const StridedMatrix<float>& a, const float* b, std::size_t rows, std::size_t inner,
                     std::size_t cols, float* out) {
  multiply_all(a, b, rows, inner, cols, out);
}

}  // namespace dermis::touch::compensation::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::touch::compensation {

HWY_EXPORT(multiply_double);
HWY_EXPORT(multiply_single);

void multiply(const StridedMatrix<double>& a, const double* b, std::size_t rows, std::size_t inner, std::size_t cols,
              double* out) noexcept {
  HWY_DYNAMIC_DISPATCH(multiply_double)(a, b, rows, inner, cols, out);
}

void multiply(const StridedMatrix<float>& a, const float* b, std::size_t rows, std::size_t inner, std::size_t cols,
              float* out) noexcept {
  HWY_DYNAMIC_DISPATCH(multiply_single)(a, b, rows, inner, cols, out);
}

}  // namespace dermis::touch::compensation
#endif
