// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "dermis/touch/fusion/material_memory.hpp"

// The arithmetic of MaterialMemory with the taxels in SIMD lanes (single precision, Highway).
namespace dermis::touch::fusion {

/// The memory of taxels stands in tiles [tiles, kStates, kTile], which are read from front to back. Rows of all taxels
/// would lie a power of two apart, and displace each other from the cache.
inline constexpr std::size_t kTile = 16;  // as many as the widest vectors have lanes

// The states of a taxel, in this order.
inline constexpr std::size_t kLoad = 0;                                         ///< f of the last step
inline constexpr std::size_t kLogarithm = 1;                                    ///< ln(1 + f) of the last step
inline constexpr std::size_t kLate = 2;                                         ///< s_k
inline constexpr std::size_t kStops = kLate + MemoryLaw::kCreepSeconds.size();  ///< m_j
inline constexpr std::size_t kStates = kStops + MemoryLaw::kStopReach.size();

/// One step in time.
struct MemoryStep {
  std::array<float, MemoryLaw::kCreepSeconds.size()> approach{};  ///< a_k
  std::array<float, MemoryLaw::kCreepSeconds.size()> late{};      ///< c_k (1 - a_k)
  std::array<float, MemoryLaw::kStopReach.size()> half_gap{};     ///< h_j / 2
  bool has_gap = false;                                           ///< Some h_j is not zero.
  std::span<const float> noise_newtons;                           ///< Of u [taxels].
  std::span<float> sigma_newtons;                                 ///< Grows; empty, as the noise: nobody asks.
  std::span<float> states;                                        ///< Of the last step, then of this one; in tiles.
  ForceSums* sums = nullptr;                                      ///< Sums of the felt forces, then of the freed ones.
};

/// Felt forces become those that are freed of the memory; NaN stays.
void step_memory(const MemoryStep& step, std::span<float> newtons) noexcept;

}  // namespace dermis::touch::fusion
