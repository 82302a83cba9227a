// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/fusion/material_memory.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <numeric>

#include "fusion/memory_kernels.hpp"

namespace dermis::fusion {
namespace {

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

void MaterialMemory::process(ForceFrame& force, std::span<const float> noise_newtons) noexcept {
  assert(force.newtons.size() == taxels_ && noise_newtons.size() == taxels_);
  if (has(force.status, FrameStatus::rejected)) return;
  if (time_ && force.time < *time_) forget();
  MemoryStep step;
  step.states = states_;
  for (std::size_t k = 0; k < law_.creep.size(); ++k) {
    double approach = 1.0;
    if (time_) {
      const double seconds = std::chrono::duration<double>(force.time - *time_).count();
      approach = -std::expm1(-seconds / MemoryLaw::kCreepSeconds[k]);
    }
    step.approach[k] = static_cast<float>(approach);
    step.late[k] = static_cast<float>(static_cast<double>(law_.creep[k]) * (1.0 - approach));
  }
  for (std::size_t j = 0; j < law_.gap.size(); ++j) step.half_gap[j] = 0.5F * law_.gap[j];
  step.noise_newtons = noise_newtons;
  if (!force.sums.newtons.empty()) step.sums = &force.sums;
  step_memory(step, force.newtons, force.sigma_newtons);
  time_ = force.time;
}

void MaterialMemory::forget() noexcept {
  time_.reset();
  std::fill(states_.begin(), states_.end(), 0.0F);
}

}  // namespace dermis::fusion
