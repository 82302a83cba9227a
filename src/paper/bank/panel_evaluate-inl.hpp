// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Included once for every instruction set, so the guard toggles.
#if defined(DERMIS_PAPER_PANEL_EVALUATE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DERMIS_PAPER_PANEL_EVALUATE_INL_HPP
#undef DERMIS_PAPER_PANEL_EVALUATE_INL_HPP
#else
#define DERMIS_PAPER_PANEL_EVALUATE_INL_HPP
#endif

#include <utility>

#include "hwy/highway.h"
#include "paper/bank/panel_layout.hpp"
#include "touch/network/activation-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using touch::network::HWY_NAMESPACE::activate;

using FullTag = hn::CappedTag<float, kLanes>;
inline constexpr std::size_t kVectorLanes = hn::MaxLanes(FullTag());

HWY_INLINE hn::Vec<FullTag> load_weights(const float* weights) {
  return hn::Load(FullTag(), weights);
}
HWY_INLINE hn::Vec<FullTag> load_weights(const hwy::float16_t* weights) {
  return hn::PromoteTo(FullTag(), hn::LoadU(hn::Rebind<hwy::float16_t, FullTag>(), weights));
}

/// Behind the outputs of a layer: the 1 that the thresholds of the next layer weigh, and zeros.
HWY_INLINE void end_row(float* row, std::size_t units) {
  row[units] = 1.0F;
  for (std::size_t k = units + 1; k % kLanes != 0; ++k) row[k] = 0.0F;
}

/// Eq. (4) for the units of one panel, `Width` of them, and one pattern. Several sums a unit hide the latency of the
/// additions: eight registers in all.
template <std::size_t Width, class Weight>
HWY_INLINE void evaluate_panel(const PanelLayer& layer, const Weight* HWY_RESTRICT weights,
                               const float* HWY_RESTRICT below, float* HWY_RESTRICT outputs) {
  const FullTag d;
  constexpr std::size_t kVectors = Width / kVectorLanes;
  constexpr std::size_t kSums = kVectors >= 8 ? 1 : 8 / kVectors;
  hn::Vec<FullTag> sums[kSums][kVectors];
  for (auto& row : sums) {
    for (auto& sum : row) sum = hn::Zero(d);
  }
  std::size_t step = 0;
  for (; step + kSums <= layer.steps(); step += kSums) {
    for (std::size_t s = 0; s < kSums; ++s) {
      const auto input = hn::Set(d, below[step + s]);
      for (std::size_t v = 0; v < kVectors; ++v) {
        sums[s][v] = hn::MulAdd(load_weights(weights + v * kVectorLanes), input, sums[s][v]);
      }
      weights += Width;
    }
  }
  for (; step < layer.steps(); ++step, weights += Width) {
    const auto input = hn::Set(d, below[step]);
    for (std::size_t v = 0; v < kVectors; ++v) {
      sums[0][v] = hn::MulAdd(load_weights(weights + v * kVectorLanes), input, sums[0][v]);
    }
  }
  for (std::size_t v = 0; v < kVectors; ++v) {
    auto sum = sums[0][v];
    for (std::size_t s = 1; s < kSums; ++s) sum = hn::Add(sum, sums[s][v]);
    hn::Store(activate(d, layer.activation, sum), d, outputs + v * kVectorLanes);
  }
}

/// Eq. (4) for a layer of one unit.
template <class Weight>
HWY_INLINE float evaluate_row(const PanelLayer& layer, const Weight* HWY_RESTRICT weights,
                              const float* HWY_RESTRICT below) {
  const FullTag d;
  auto sum = hn::Zero(d);
  for (std::size_t k = 0; k < layer.size(); k += kVectorLanes) {
    sum = hn::MulAdd(load_weights(weights + k), hn::Load(d, below + k), sum);
  }
  return hn::GetLane(activate(d, layer.activation, hn::SumOfLanes(d, sum)));
}

/// Eq. (4) for one network and one pattern. `inputs` ends as end_row() leaves it; `space` holds two rows of
/// layout.widest().
template <class Weight>
void evaluate_network(const PanelLayout& layout, const Weight* weights, const float* inputs, float* space,
                      float* outputs) {
  const float* below = inputs;
  float* above = space;
  float* next = space + layout.widest();
  for (const PanelLayer& layer : layout.layers()) {
    if (layer.is_row()) {
      above[0] = evaluate_row(layer, weights + layer.first, below);
    } else {
      std::size_t unit = 0;
      for (; unit + kPanelUnits <= layer.padded_units(); unit += kPanelUnits) {
        evaluate_panel<kPanelUnits>(layer, weights + layer.panel(unit), below, above + unit);
      }
      if (unit < layer.padded_units()) evaluate_panel<kLanes>(layer, weights + layer.panel(unit), below, above + unit);
    }
    end_row(above, layer.units);
    below = above;
    std::swap(above, next);
  }
  std::copy_n(below, layout.outputs(), outputs);
}

}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
