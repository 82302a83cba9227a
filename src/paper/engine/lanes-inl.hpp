// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Lanes of the engine, and loops over them that keep what they index in registers.
// Included once for every instruction set, so the guard toggles.
#if defined(DERMIS_PAPER_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DERMIS_PAPER_LANES_INL_HPP
#undef DERMIS_PAPER_LANES_INL_HPP
#else
#define DERMIS_PAPER_LANES_INL_HPP
#endif

#include <cstddef>
#include <type_traits>
#include <utility>

#include "hwy/highway.h"
#include "paper/engine/feed_forward_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <typename Real>
using Lanes = hn::CappedTag<Real, kCacheLineBytes / sizeof(Real)>;

/// Vectors that a kernel works on at a time: sums and what they are made of fit the registers.
constexpr std::size_t kVectors = HWY_TARGET <= HWY_AVX3 || HWY_ARCH_ARM ? 4 : 2;

/// Calls body(0) ... body(Count - 1) with constants, so that what they index stays in registers.
template <std::size_t Count, class Body>
HWY_INLINE void unroll(const Body& body) {
  const auto call = [&]<std::size_t... K>(std::index_sequence<K...>)
                        HWY_ATTR { (body(std::integral_constant<std::size_t, K>()), ...); };
  call(std::make_index_sequence<Count>());
}

/// Calls body(first, std::integral_constant<n>) for first = 0, AtOnce, ...; n = AtOnce, for the rest 1.
template <std::size_t AtOnce, class Body>
HWY_INLINE void in_blocks(std::size_t count, const Body& body) {
  std::size_t first = 0;
  for (; first + AtOnce <= count; first += AtOnce) body(first, std::integral_constant<std::size_t, AtOnce>());
  for (; first < count; ++first) body(first, std::integral_constant<std::size_t, 1>());
}

}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // DERMIS_PAPER_LANES_INL_HPP
