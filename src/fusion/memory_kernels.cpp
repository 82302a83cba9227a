// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "fusion/memory_kernels.hpp"

#include <cstddef>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fusion/memory_kernels.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace dermis::fusion::HWY_NAMESPACE {
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

template <class D>
HWY_INLINE void step_lanes(D d, const MemoryStep& step, std::size_t first, float* newtons, float* sigma_newtons) {
  float* const states = step.states.data() + first / kTile * kTile * kStates + first % kTile;
  const auto state = [&](std::size_t which) { return hn::LoadU(d, states + which * kTile); };
  const auto remember = [&](std::size_t which, hn::Vec<D> value) { hn::StoreU(value, d, states + which * kTile); };
  constexpr std::size_t kCreeps = MemoryLaw::kCreepSeconds.size();
  const auto one = hn::Set(d, 1.0F);
  const auto material = hn::LoadU(d, newtons + first);
  const auto is_known = hn::Eq(material, material);
  auto late = hn::Zero(d);
  float of_load = 1.0F;
  hn::Vec<D> creep[kCreeps];
  for (std::size_t k = 0; k < kCreeps; ++k) {
    creep[k] = state(kLate + k);
    late = hn::MulAdd(hn::Set(d, step.late[k]), creep[k], late);
    of_load -= step.late[k];
  }
  const auto gain = hn::Set(d, 1.0F / of_load);
  const auto most = hn::Set(d, kMostNewtons);
  const auto limited = hn::Mul(hn::Sub(signed_material(d, step, first, material), late), gain);
  const auto signed_load = hn::IfThenElse(is_known, hn::Clamp(limited, hn::Neg(most), most), state(kLoad));
  const auto load = hn::Max(signed_load, hn::Zero(d));
  const auto logarithm = hn::Log(d, hn::Add(load, one));
  const auto change = hn::Sub(logarithm, state(kLogarithm));
  remember(kLoad, load);
  remember(kLogarithm, logarithm);
  for (std::size_t k = 0; k < kCreeps; ++k) {
    remember(kLate + k, hn::MulAdd(hn::Set(d, step.approach[k]), hn::Sub(signed_load, creep[k]), creep[k]));
  }
  auto share = one;
  for (std::size_t j = 0; j < step.half_gap.size(); ++j) {
    const auto moved = hn::MulAdd(change, hn::Set(d, 1.0F / MemoryLaw::kStopReach[j]), state(kStops + j));
    const auto stop = hn::Clamp(moved, hn::Neg(one), one);
    remember(kStops + j, stop);
    share = hn::MulAdd(hn::Set(d, step.half_gap[j]), stop, share);
  }
  const auto freed = hn::Mul(load, share);
  hn::StoreU(hn::IfThenElse(is_known, freed, material), d, newtons + first);
  const auto sigma = hn::LoadU(d, sigma_newtons + first);
  const auto noise = hn::LoadU(d, step.noise_newtons.data() + first);
  const auto lasting = hn::Max(hn::MulSub(sigma, sigma, hn::Mul(noise, noise)), hn::Zero(d));
  const auto growth = hn::Max(hn::IfThenElse(hn::Gt(material, hn::Zero(d)), hn::Div(freed, material), one), one);
  const auto by_noise = hn::Mul(share, gain);
  const auto noise_now = hn::Mul(noise, by_noise);
  const auto variance = hn::MulAdd(hn::Mul(growth, growth), lasting, hn::Mul(noise_now, noise_now));
  const auto least = hn::Set(d, std::numeric_limits<float>::min());
  hn::StoreU(hn::IfThenElse(is_known, hn::Max(hn::Sqrt(variance), least), sigma), d, sigma_newtons + first);
  if (step.sums != nullptr) free_sums(d, *step.sums, first, late, by_noise, growth);
}

/// By value: stores of vectors may alias what is reached through a reference.
void step_all(const MemoryStep step, std::size_t taxels, float* newtons, float* sigma_newtons) {
  const hn::ScalableTag<float> d;
  static_assert(kTile % hn::MaxLanes(d) == 0);
  const std::size_t lanes = hn::Lanes(d);
  std::size_t first = 0;
  for (; first + lanes <= taxels; first += lanes) step_lanes(d, step, first, newtons, sigma_newtons);
  for (; first < taxels; ++first) step_lanes(hn::CappedTag<float, 1>(), step, first, newtons, sigma_newtons);
}

}  // namespace dermis::fusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::fusion {

HWY_EXPORT(step_all);

void step_memory(const MemoryStep& step, std::span<float> newtons, std::span<float> sigma_newtons) noexcept {
  HWY_DYNAMIC_DISPATCH(step_all)(step, newtons.size(), newtons.data(), sigma_newtons.data());
}

}  // namespace dermis::fusion
#endif
