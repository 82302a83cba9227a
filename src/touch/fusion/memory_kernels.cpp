// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/fusion/memory_kernels.hpp"

#include <cstddef>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "touch/fusion/memory_kernels.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace dermis::touch::fusion::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr float kMostNewtons = 1e6F;  // that a taxel can remember: keeps the states finite

/// A signed force is freed by the same creep and share, without the cut at zero.
template <class D>
void free_sums(D d, ForceSums& sums, std::size_t first, hn::Vec<D> late, hn::Vec<D> by_noise, hn::Vec<D> growth) {
  const auto scale = [&](std::vector<float>& values, hn::Vec<D> factor) {
    hn::StoreU(hn::Mul(hn::LoadU(d, values.data() + first), factor), d, values.data() + first);
  };
  float* const newtons = sums.newtons.data() + first;
  hn::StoreU(hn::Mul(hn::Sub(hn::LoadU(d, newtons), late), by_noise), d, newtons);
  scale(sums.own_variance, hn::Mul(growth, growth));
  scale(sums.newtons_per_siemens, by_noise);
  scale(sums.newtons_per_celsius, growth);
}

/// Below zero where nothing presses, so that the states do not add up its noise.
template <class D>
hn::Vec<D> signed_material(D d, const MemoryStep& step, std::size_t first, hn::Vec<D> material) {
  if (step.sums == nullptr) return material;
  return hn::IfThenElse(hn::Gt(material, hn::Zero(d)), material, hn::LoadU(d, step.sums->newtons.data() + first));
}

/// What the stops make of a load: 1 + sum_j h_j m_j / 2.
template <class D>
HWY_INLINE hn::Vec<D> moved_stops(D d, const MemoryStep& step, float* states, hn::Vec<D> load) {
  const auto one = hn::Set(d, 1.0F);
  if (!step.has_gap) return one;
  const auto logarithm = hn::Log(d, hn::Add(load, one));
  const auto change = hn::Sub(logarithm, hn::LoadU(d, states + kLogarithm * kTile));
  hn::StoreU(logarithm, d, states + kLogarithm * kTile);
  auto share = one;
  for (std::size_t j = 0; j < step.half_gap.size(); ++j) {
    float* const at = states + (kStops + j) * kTile;
    const auto moved = hn::MulAdd(change, hn::Set(d, 1.0F / MemoryLaw::kStopReach[j]), hn::LoadU(d, at));
    const auto stop = hn::Clamp(moved, hn::Neg(one), one);
    hn::StoreU(stop, d, at);
    share = hn::MulAdd(hn::Set(d, step.half_gap[j]), stop, share);
  }
  return share;
}

/// The standard deviation of what is freed: a lasting part grows with it, noise passes by `by_noise`.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V freed_sigma(D d, V sigma, V noise, V growth, V by_noise) {
  const auto lasting = hn::Max(hn::MulSub(sigma, sigma, hn::Mul(noise, noise)), hn::Zero(d));
  const auto noise_now = hn::Mul(noise, by_noise);
  const auto variance = hn::MulAdd(hn::Mul(growth, growth), lasting, hn::Mul(noise_now, noise_now));
  const auto least = hn::Set(d, std::numeric_limits<float>::min());
  return hn::Max(hn::Sqrt(variance), least);
}

template <class D>
HWY_INLINE void step_lanes(D d, const MemoryStep& step, std::size_t first, float* newtons) {
  float* const states = step.states.data() + first / kTile * kTile * kStates + first % kTile;
  constexpr std::size_t kCreeps = MemoryLaw::kCreepSeconds.size();
  const auto one = hn::Set(d, 1.0F);
  const auto material = hn::LoadU(d, newtons + first);
  const auto is_known = hn::Eq(material, material);
  auto late = hn::Zero(d);
  float of_load = 1.0F;
  hn::Vec<D> creep[kCreeps];
  for (std::size_t k = 0; k < kCreeps; ++k) {
    creep[k] = hn::LoadU(d, states + (kLate + k) * kTile);
    late = hn::MulAdd(hn::Set(d, step.late[k]), creep[k], late);
    of_load -= step.late[k];
  }
  const auto gain = hn::Set(d, 1.0F / of_load);
  const auto most = hn::Set(d, kMostNewtons);
  const auto limited = hn::Mul(hn::Sub(signed_material(d, step, first, material), late), gain);
  const auto signed_load =
      hn::IfThenElse(is_known, hn::Clamp(limited, hn::Neg(most), most), hn::LoadU(d, states + kLoad * kTile));
  const auto load = hn::Max(signed_load, hn::Zero(d));
  hn::StoreU(load, d, states + kLoad * kTile);
  for (std::size_t k = 0; k < kCreeps; ++k) {
    const auto moved = hn::MulAdd(hn::Set(d, step.approach[k]), hn::Sub(signed_load, creep[k]), creep[k]);
    hn::StoreU(moved, d, states + (kLate + k) * kTile);
  }
  const auto share = moved_stops(d, step, states, load);
  const auto freed = hn::Mul(load, share);
  hn::StoreU(hn::IfThenElse(is_known, freed, material), d, newtons + first);
  if (step.sigma_newtons.empty()) return;
  float* const sigma_newtons = step.sigma_newtons.data() + first;
  const auto sigma = hn::LoadU(d, sigma_newtons);
  const auto noise = hn::LoadU(d, step.noise_newtons.data() + first);
  const auto growth = hn::Max(hn::IfThenElse(hn::Gt(material, hn::Zero(d)), hn::Div(freed, material), one), one);
  const auto by_noise = hn::Mul(share, gain);
  hn::StoreU(hn::IfThenElse(is_known, freed_sigma(d, sigma, noise, growth, by_noise), sigma), d, sigma_newtons);
  if (step.sums != nullptr) free_sums(d, *step.sums, first, late, by_noise, growth);
}

/// By value: stores of vectors may alias what is reached through a reference.
void step_all(const MemoryStep step, std::size_t taxels, float* newtons) {
  const hn::CappedTag<float, kTile> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t first = 0;
  for (; first + lanes <= taxels; first += lanes) step_lanes(d, step, first, newtons);
  for (; first < taxels; ++first) step_lanes(hn::CappedTag<float, 1>(), step, first, newtons);
}

}  // namespace dermis::touch::fusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::touch::fusion {

HWY_EXPORT(step_all);

void step_memory(const MemoryStep& step, std::span<float> newtons) noexcept {
  HWY_DYNAMIC_DISPATCH(step_all)(step, newtons.size(), newtons.data());
}

}  // namespace dermis::touch::fusion
#endif
