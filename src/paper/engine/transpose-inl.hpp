// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Samples side by side from samples one after another, and back.
// Included once for every instruction set, so the guard toggles.
#if defined(DERMIS_PAPER_TRANSPOSE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DERMIS_PAPER_TRANSPOSE_INL_HPP
#undef DERMIS_PAPER_TRANSPOSE_INL_HPP
#else
#define DERMIS_PAPER_TRANSPOSE_INL_HPP
#endif

#include <algorithm>
#include <cstddef>

#include "hwy/highway.h"
#include "paper/engine/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR
template <typename Real>
constexpr std::size_t kSquare = 1;

template <typename Real>
HWY_INLINE void transpose_square(const Real* const (&in)[1], Real* const (&out)[1]) {
  *out[0] = *in[0];
}
#else
/// Rows and columns that fill 128 bits: shuffles within them are cheap everywhere.
template <typename Real>
constexpr std::size_t kSquare = 16 / sizeof(Real);

HWY_INLINE void transpose_square(const float* const (&in)[4], float* const (&out)[4]) {
  const hn::FixedTag<float, 4> d;
  const hn::FixedTag<double, 2> pairs;
  const auto interleave = [d, pairs](const float* above, const float* below, auto& low, auto& high) HWY_ATTR {
    const auto a = hn::LoadU(d, above);
    const auto b = hn::LoadU(d, below);
    low = hn::BitCast(pairs, hn::InterleaveLower(d, a, b));
    high = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b));
  };
  hn::Vec<decltype(pairs)> low01;
  hn::Vec<decltype(pairs)> high01;
  hn::Vec<decltype(pairs)> low23;
  hn::Vec<decltype(pairs)> high23;
  interleave(in[0], in[1], low01, high01);
  interleave(in[2], in[3], low23, high23);
  hn::StoreU(hn::BitCast(d, hn::InterleaveLower(pairs, low01, low23)), d, out[0]);
  hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(pairs, low01, low23)), d, out[1]);
  hn::StoreU(hn::BitCast(d, hn::InterleaveLower(pairs, high01, high23)), d, out[2]);
  hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(pairs, high01, high23)), d, out[3]);
}

HWY_INLINE void transpose_square(const double* const (&in)[2], double* const (&out)[2]) {
  const hn::FixedTag<double, 2> d;
  const auto a = hn::LoadU(d, in[0]);
  const auto b = hn::LoadU(d, in[1]);
  hn::StoreU(hn::InterleaveLower(d, a, b), d, out[0]);
  hn::StoreU(hn::InterleaveUpper(d, a, b), d, out[1]);
}
#endif

/// in(row) [columns] -> out(column) [rows].
template <typename Real, class In, class Out>
HWY_INLINE void transpose(std::size_t rows, std::size_t columns, const In& in, const Out& out) {
  constexpr std::size_t kSide = kSquare<Real>;
  const auto one = [&](std::size_t row, std::size_t column) HWY_ATTR { out(column)[row] = in(row)[column]; };
  std::size_t row = 0;
  for (; row + kSide <= rows; row += kSide) {
    std::size_t column = 0;
    for (; column + kSide <= columns; column += kSide) {
      const Real* from[kSide];
      Real* to[kSide];
      unroll<kSide>([&](auto k) HWY_ATTR {
        from[k] = in(row + k) + column;
        to[k] = out(column + k) + row;
      });
      transpose_square(from, to);
    }
    for (; column < columns; ++column) unroll<kSide>([&](auto k) HWY_ATTR { one(row + k, column); });
  }
  for (; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) one(row, column);
  }
}

/// rows(p) points to `columns` values of sample p -> out [columns, kTile], samples 0 ... count - 1.
template <typename Real, class Rows>
HWY_INLINE void to_columns(std::size_t columns, std::size_t count, const Rows& rows, Real* out) {
  transpose<Real>(count, columns, rows, [out](std::size_t k) HWY_ATTR { return out + k * kTile; });
}

/// in [columns, kTile] -> out [count, columns].
template <typename Real>
HWY_INLINE void to_rows(std::size_t columns, std::size_t count, const Real* in, Real* out) {
  if (columns == 1) {
    std::copy_n(in, count, out);
    return;
  }
  transpose<Real>(
      columns, count, [in](std::size_t k) HWY_ATTR { return in + k * kTile; },
      [out, columns](std::size_t p) HWY_ATTR { return out + p * columns; });
}

}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // DERMIS_PAPER_TRANSPOSE_INL_HPP
