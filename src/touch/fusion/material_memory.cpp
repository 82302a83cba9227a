// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/fusion/material_memory.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <numeric>

#include "touch/fusion/memory_kernels.hpp"

namespace dermis::touch::fusion {
namespace {

constexpr MaterialMemory::Approach kAtOnce{1.0, 1.0, 1.0, 1.0};
constexpr float kMostRemembered = 0.9F;  // of a load: the inverse multiplies noise by ten there

template <typename Shares>
bool are_shares(const Shares& shares) {
  const bool are_positive = std::all_of(shares.begin(), shares.end(), [](float share) { return share >= 0.0F; });
  return are_positive && std::accumulate(shares.begin(), shares.end(), 0.0F) < kMostRemembered;
}

}  // namespace

bool MemoryLaw::is_consistent() const noexcept {
  return are_shares(creep) && are_shares(gap);
}

MaterialMemory::MaterialMemory(const MemoryLaw& law, std::size_t taxels)
    : law_(law), taxels_(taxels), states_((taxels + kTile - 1) / kTile * kTile * kStates) {
  assert(law.is_consistent());
}

MaterialMemory::Approach MaterialMemory::approach(Nanos interval) noexcept {
  const double seconds = std::chrono::duration<double>(interval).count();
  Approach approach;
  for (std::size_t k = 0; k < approach.size(); ++k) approach[k] = -std::expm1(-seconds / MemoryLaw::kCreepSeconds[k]);
  return approach;
}

void MaterialMemory::process(ForceFrame& force, std::span<const float> noise_newtons) noexcept {
  assert(force.newtons.size() == taxels_ && noise_newtons.size() == taxels_);
  if (has(force.status, FrameStatus::rejected)) return;
  if (time_ && force.time < *time_) forget();
  MemoryStep step = this->step(time_ ? approach(force.time - *time_) : kAtOnce);
  step.noise_newtons = noise_newtons;
  step.sigma_newtons = force.sigma_newtons;
  if (!force.sums.newtons.empty()) step.sums = &force.sums;
  step_memory(step, force.newtons);
  time_ = force.time;
}

void MaterialMemory::process(std::span<float> newtons, const std::optional<Approach>& approach) noexcept {
  assert(newtons.size() == taxels_);
  if (!approach) forget();
  step_memory(step(approach.value_or(kAtOnce)), newtons);
}

MemoryStep MaterialMemory::step(const Approach& approach) noexcept {
  MemoryStep step;
  step.states = states_;
  for (std::size_t k = 0; k < approach.size(); ++k) {
    step.approach[k] = static_cast<float>(approach[k]);
    step.late[k] = static_cast<float>(static_cast<double>(law_.creep[k]) * (1.0 - approach[k]));
  }
  for (std::size_t j = 0; j < law_.gap.size(); ++j) step.half_gap[j] = 0.5F * law_.gap[j];
  step.has_gap = law_.gap != decltype(law_.gap){};
  return step;
}

void MaterialMemory::forget() noexcept {
  time_.reset();
  std::fill(states_.begin(), states_.end(), 0.0F);
}

}  // namespace dermis::touch::fusion
