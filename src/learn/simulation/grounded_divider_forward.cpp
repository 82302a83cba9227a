// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/simulation/grounded_divider_forward.hpp"

#include <algorithm>
#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "learn/simulation/grounded_divider_forward.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace dermis::learn::simulation::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMostLanes = 16;

/// Rows of `stride` values: zeros fill up the columns to whole vectors.
template <typename Real>
struct Workspace {
  std::size_t rows;
  std::size_t cols;
  std::size_t stride;
  HWY_ALIGN Real siemens[kMostFastLines * kMostFastLines];   // G
  HWY_ALIGN Real weighted[kMostFastLines * kMostFastLines];  // diag(Rd / a) G, later the readings
  HWY_ALIGN Real inverse[kMostFastLines * kMostFastLines];   // C, then its inverse
  HWY_ALIGN Real line[kMostFastLines];
  Real line_ratio[kMostFastLines];  // 1 / a
};

/// Rows row ... row + Rows - 1 of a b, one vector wide: a's element (i, l) stands at a[i * row_step + l * col_step].
template <std::size_t Rows, class D, typename Real = hn::TFromD<D>>
HWY_INLINE void multiply_block(D d, const Real* HWY_RESTRICT a, std::size_t row_step, std::size_t col_step,
                               const Real* HWY_RESTRICT b, std::size_t inner, std::size_t stride,
                               Real* HWY_RESTRICT out) {
  hn::Vec<D> sum[Rows];
  for (std::size_t r = 0; r < Rows; ++r) sum[r] = hn::Zero(d);
  for (std::size_t l = 0; l < inner; ++l) {
    const auto values = hn::Load(d, b + l * stride);
    for (std::size_t r = 0; r < Rows; ++r) {
      sum[r] = hn::MulAdd(hn::Set(d, a[r * row_step + l * col_step]), values, sum[r]);
    }
  }
  for (std::size_t r = 0; r < Rows; ++r) hn::Store(sum[r], d, out + r * stride);
}

template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE void multiply(D d, const Real* HWY_RESTRICT a, std::size_t row_step, std::size_t col_step, const Real* b,
                         std::size_t rows, std::size_t inner, std::size_t stride, Real* out) {
  constexpr std::size_t kBlock = 8;
  for (std::size_t col = 0; col < stride; col += hn::Lanes(d)) {
    std::size_t row = 0;
    for (; row + kBlock <= rows; row += kBlock) {
      multiply_block<kBlock>(d, a + row * row_step, row_step, col_step, b + col, inner, stride,
                             out + row * stride + col);
    }
    for (; row < rows; ++row) {
      multiply_block<1>(d, a + row * row_step, row_step, col_step, b + col, inner, stride, out + row * stride + col);
    }
  }
}

template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE void load(D d, const double* drive_ohm, const Real* HWY_RESTRICT siemens, Workspace<Real>& work) {
  for (std::size_t row = 0; row < work.rows; ++row) {
    Real* const line = work.siemens + row * work.stride;
    std::fill(std::copy_n(siemens + row * work.cols, work.cols, line), line + work.stride, Real{0});
    hn::Vec<D> sum = hn::Zero(d);
    for (std::size_t col = 0; col < work.stride; col += hn::Lanes(d)) sum = hn::Add(sum, hn::Load(d, line + col));
    const Real ohm = static_cast<Real>(drive_ohm[row]);
    const Real ratio = 1 / (1 + ohm * hn::GetLane(hn::SumOfLanes(d, sum)));
    work.line_ratio[row] = ratio;
    const auto weight = hn::Set(d, ohm * ratio);
    for (std::size_t col = 0; col < work.stride; col += hn::Lanes(d)) {
      hn::Store(hn::Mul(weight, hn::Load(d, line + col)), d, work.weighted + row * work.stride + col);
    }
  }
}

/// -C, whose sign spares negating a product, into `inverse`.
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE void eliminate_rows(D d, const double* load_ohm, Workspace<Real>& work) {
  multiply(d, work.weighted, 1, work.stride, work.siemens, work.cols, work.rows, work.stride, work.inverse);
  for (std::size_t col = 0; col < work.stride; col += hn::Lanes(d)) {
    hn::Vec<D> sum = hn::Zero(d);
    for (std::size_t row = 0; row < work.rows; ++row) {
      sum = hn::Add(sum, hn::Load(d, work.siemens + row * work.stride + col));
    }
    hn::Store(sum, d, work.line + col);
  }
  for (std::size_t col = 0; col < work.cols; ++col) {
    work.inverse[col * work.stride + col] -= work.line[col] + 1 / static_cast<Real>(load_ohm[col]);
  }
}

/// Subtracts line[row] times the scaled pivot row from the rows first ... last - 1 at one vector of columns, after
/// taking `gone` from them.
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE void sweep(D d, std::size_t first, std::size_t last, std::size_t col, hn::Vec<D> scaled, hn::Mask<D> gone,
                      Workspace<Real>& work) {
  for (std::size_t row = first; row < last; ++row) {
    Real* const values = work.inverse + row * work.stride + col;
    const auto left = hn::IfThenZeroElse(gone, hn::Load(d, values));
    hn::Store(hn::NegMulAdd(hn::Set(d, work.line[row]), scaled, left), d, values);
  }
}

/// Gauss and Jordan, in place. The matrix stays symmetric but for the signs between rows that have and have not been
/// pivots. So the pivot's column is read from its row.
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE void invert(D d, Workspace<Real>& work) {
  for (std::size_t pivot = 0; pivot < work.cols; ++pivot) {
    Real* const pivot_row = work.inverse + pivot * work.stride;
    const auto scale = hn::Set(d, 1 / pivot_row[pivot]);
    const auto place = hn::Set(d, static_cast<Real>(pivot));
    for (std::size_t col = 0; col < work.stride; col += hn::Lanes(d)) {
      const auto was_pivot = hn::Lt(hn::Iota(d, static_cast<Real>(col)), place);
      const auto values = hn::Load(d, pivot_row + col);
      hn::Store(hn::IfThenElse(was_pivot, hn::Neg(values), values), d, work.line + col);
    }
    for (std::size_t col = 0; col < work.stride; col += hn::Lanes(d)) {
      const auto is_pivot = hn::Eq(hn::Iota(d, static_cast<Real>(col)), place);
      const auto values = hn::IfThenElse(is_pivot, hn::Set(d, Real{1}), hn::Load(d, pivot_row + col));
      const auto scaled = hn::Mul(scale, values);
      hn::Store(scaled, d, pivot_row + col);
      sweep(d, 0, pivot, col, scaled, is_pivot, work);
      sweep(d, pivot + 1, work.cols, col, scaled, is_pivot, work);
    }
  }
}

template <typename Real>
void find_ratios(const double* drive_ohm, const double* load_ohm, const Real* siemens, std::size_t rows,
                 std::size_t cols, Real* ratio) {
  const hn::CappedTag<Real, kMostLanes> d;
  Workspace<Real> work;  // NOLINT(cppcoreguidelines-pro-type-member-init): each part is written before it is read
  work.rows = rows;
  work.cols = cols;
  work.stride = (cols + hn::Lanes(d) - 1) / hn::Lanes(d) * hn::Lanes(d);
  load(d, drive_ohm, siemens, work);
  eliminate_rows(d, load_ohm, work);
  invert(d, work);
  multiply(d, work.siemens, work.stride, 1, work.inverse, rows, cols, work.stride, work.weighted);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t col = 0; col < cols; ++col) {
      ratio[row * cols + col] = 0 - work.line_ratio[row] * work.weighted[row * work.stride + col];  // 0, not -0
    }
  }
}

void find_ratios_float(const double* drive_ohm, const double* load_ohm, const float* siemens, std::size_t rows,
                       std::size_t cols, float* ratio) {
  find_ratios(drive_ohm, load_ohm, siemens, rows, cols, ratio);
}

void find_ratios_double(const double* drive_ohm, const double* load_ohm, const double* siemens, std::size_t rows,
                        std::size_t cols, double* ratio) {
  find_ratios(drive_ohm, load_ohm, siemens, rows, cols, ratio);
}

}  // namespace dermis::learn::simulation::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::learn::simulation {

HWY_EXPORT(find_ratios_float);
HWY_EXPORT(find_ratios_double);

bool fits_grounded_divider(const ArrayDescription& array) noexcept {
  const Readout& readout = array.readout;
  return readout.circuit == Circuit::divider && readout.idle_rows == IdleRows::grounded &&
         readout.idle_columns == IdleColumns::loaded && readout.row_segment_ohm.empty() &&
         readout.column_segment_ohm.empty() && readout.supply_ohm.value_or(0.0) == 0.0 && !readout.film &&
         std::max(array.rows, array.cols) <= kMostFastLines;
}

void grounded_divider_ratios(const Readout& readout, std::span<const float> siemens, std::span<float> ratio) noexcept {
  assert(siemens.size() == readout.drive_ohm.size() * readout.load_ohm.size() && ratio.size() == siemens.size());
  HWY_DYNAMIC_DISPATCH(find_ratios_float)
  (readout.drive_ohm.data(), readout.load_ohm.data(), siemens.data(), readout.drive_ohm.size(), readout.load_ohm.size(),
   ratio.data());
}

void grounded_divider_ratios(const Readout& readout, std::span<const double> siemens,
                             std::span<double> ratio) noexcept {
  assert(siemens.size() == readout.drive_ohm.size() * readout.load_ohm.size() && ratio.size() == siemens.size());
  HWY_DYNAMIC_DISPATCH(find_ratios_double)
  (readout.drive_ohm.data(), readout.load_ohm.data(), siemens.data(), readout.drive_ohm.size(), readout.load_ohm.size(),
   ratio.data());
}

}  // namespace dermis::learn::simulation
#endif  // HWY_ONCE
