// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Included once for every instruction set, so the guard toggles.
#if defined(DERMIS_PAPER_PANEL_TILES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DERMIS_PAPER_PANEL_TILES_INL_HPP
#undef DERMIS_PAPER_PANEL_TILES_INL_HPP
#else
#define DERMIS_PAPER_PANEL_TILES_INL_HPP
#endif

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "hwy/highway.h"
#include "paper/bank/panel_evaluate-inl.hpp"
#include "paper/bank/panel_layout.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A tile of a product lies in registers: 16 of the 32 of AVX-512, 8 of the 16 elsewhere.
inline constexpr std::size_t kTileRows = kVectorLanes == kLanes ? 8 : 4;
inline constexpr std::size_t kTileVectors = 2;

using FullVector = hn::Vec<FullTag>;

struct NoPrefetch {
  HWY_INLINE void next() const {}
};

/// Fetches memory that is needed soon into the second-level cache, a quarter of a cache line at every step of a
/// product. Harmless beyond the end of the bank.
class Prefetch {
 public:
  explicit Prefetch(const float* place) : place_(place) {}

  HWY_INLINE void next() {
    __builtin_prefetch(place_, 0, 2);
    place_ += 4;
  }

 private:
  const float* place_;
};

/// sums[r][v] += sum over `steps` of a[r * a_row + step * a_step] * vector v of b[step * b_step].
template <std::size_t Rows, std::size_t Vectors, class Fetch = NoPrefetch>
HWY_INLINE void accumulate(const float* HWY_RESTRICT a, std::size_t a_row, std::size_t a_step,
                           const float* HWY_RESTRICT b, std::size_t b_step, std::size_t steps,
                           FullVector (&sums)[Rows][Vectors], Fetch fetch = {}) {
  const FullTag d;
  for (std::size_t step = 0; step < steps; ++step, a += a_step, b += b_step) {
    fetch.next();
    FullVector right[Vectors];
    for (std::size_t v = 0; v < Vectors; ++v) right[v] = hn::Load(d, b + v * kVectorLanes);
    for (std::size_t r = 0; r < Rows; ++r) {
      const auto left = hn::Set(d, a[r * a_row]);
      for (std::size_t v = 0; v < Vectors; ++v) sums[r][v] = hn::MulAdd(left, right[v], sums[r][v]);
    }
  }
}

template <std::size_t Rows, std::size_t Vectors>
HWY_INLINE void clear(FullVector (&sums)[Rows][Vectors]) {
  for (auto& row : sums) {
    for (auto& sum : row) sum = hn::Zero(FullTag());
  }
}

/// Calls tile(row) with as many rows at a time as Rows, then with the halves for the rest.
template <std::size_t Rows, class Tile>
HWY_INLINE void for_each_tile(std::size_t row, std::size_t rows, const Tile& tile) {
  for (; row + Rows <= rows; row += Rows) tile(std::integral_constant<std::size_t, Rows>(), row);
  if constexpr (Rows > 1) for_each_tile<Rows / 2>(row, rows, tile);
}

/// A batch of one network's patterns between two levels.
struct Level {
  float* values;
  std::size_t stride;
};

/// Calls columns(vectors, width, first unit, its weights) for tiles of columns of a panel that starts with `unit`.
template <std::size_t Width, class Columns>
HWY_INLINE void for_each_panel_columns(const PanelLayer& layer, std::size_t unit, const Columns& columns) {
  constexpr std::integral_constant<std::size_t, Width> kWidth;
  constexpr std::integral_constant<std::size_t, std::min(kTileVectors, Width / kVectorLanes)> kVectors;
  for (std::size_t column = 0; column < Width; column += kVectors() * kVectorLanes) {
    columns(kVectors, kWidth, unit + column, layer.panel(unit) + column);
  }
}

/// The same for all panels of a layer.
template <class Columns>
HWY_INLINE void for_each_columns(const PanelLayer& layer, const Columns& columns) {
  std::size_t unit = 0;
  for (; unit + kPanelUnits <= layer.padded_units(); unit += kPanelUnits) {
    for_each_panel_columns<kPanelUnits>(layer, unit, columns);
  }
  if (unit < layer.padded_units()) for_each_panel_columns<kLanes>(layer, unit, columns);
}

}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
