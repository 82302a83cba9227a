// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <span>

#include "dermis/fusion/material_memory.hpp"

// The arithmetic of MaterialMemory with the taxels in SIMD lanes (single precision, Highway).
namespace dermis::fusion {

/// One step in time; vectors [taxels] where nothing else is said.
struct MemoryStep {
  std::array<float, MemoryLaw::kCreepSeconds.size()> approach{};  ///< a_k
  std::array<float, MemoryLaw::kCreepSeconds.size()> late{};      ///< c_k (1 - a_k)
  std::array<float, MemoryLaw::kStopReach.size()> half_gap{};     ///< h_j / 2
  bool has_gap = false;                                           ///< Some h_j is not zero.
  std::span<const float> noise_newtons;                           ///< Of u.
  std::span<float> sigma_newtons;                                 ///< Grows; empty, as the noise: nobody asks.
  std::span<float> newtons;                                       ///< f, then the one of this step
  std::span<float> logarithm;                                     ///< ln(1 + f), likewise
  std::span<float> late_newtons;                                  ///< s_k [4, taxels], likewise
  std::span<float> stops;                                         ///< m_j [3, taxels], likewise
  ForceSums* sums = nullptr;                                      ///< Sums of the felt forces, then of the freed ones.
};

/// Felt forces become those that are freed of the memory; NaN stays.
void step_memory(const MemoryStep& step, std::span<float> newtons) noexcept;

}  // namespace dermis::fusion
