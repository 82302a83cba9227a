// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::fusion {

struct MemoryStep;

/// The memory of the material of a sheet: how the force that it feels, which the networks give, follows the load. It is
/// the same for all taxels, as it belongs to the rubber.
struct MemoryLaw {
  static constexpr std::array<double, 4> kCreepSeconds{0.1, 1.0, 10.0, 100.0};  ///< tau_k [s].
  static constexpr std::array<float, 3> kStopReach{0.1F, 0.3F, 1.0F};           ///< r_j.

  std::array<float, 4> creep{};  ///< c_k: shares of the load that are felt late, >= 0, together less than 0.9.
  std::array<float, 3> gap{};    ///< h_j: gaps between loading and unloading, relative, >= 0, together less than 0.9.

  /// Every number is in its range.
  [[nodiscard]] bool is_consistent() const noexcept;

  bool operator==(const MemoryLaw&) const = default;
};

/// Frees the forces of the networks from what the material remembers. Let a taxel feel u [N] after the interval dt
/// since the frame before, with a_k = 1 - exp(-dt / tau_k):
///
///   creep       f = max(0, u - sum_k c_k (1 - a_k) s_k) / (1 - sum_k c_k (1 - a_k)),   s_k <- s_k + a_k (f - s_k)
///   hysteresis  m_j <- clamp(m_j + d ln(1 + f/1 N) / r_j, -1, 1),   newtons = f (1 + sum_j h_j m_j / 2)
///
/// The first inverts an elastic layer in series with a Kelvin-Voigt element for each tau_k, u = f (1 - sum c) + sum c
/// s. It is exact for any intervals where the load of a frame lies on the taxel since the frame before. The second
/// undoes stops (Prandtl 1928): the material reads low after loading and high after unloading.
///
/// Where nothing presses, u is the signed force of ForceFrame::sums, so the states do not add up its noise.
///
/// The states are bounded by the heaviest load that was, whatever the frames are. A load on the array in the first
/// frame counts as lying there for long. A frame that is earlier than the one before it is the first of a recording
/// that begins anew. A taxel without a force counts as carrying its last one, a rejected frame as none at all.
///
/// The noise of u is new in each frame and grows by d newtons / d u. All else that a standard deviation covers stays
/// for a touch, states included: it grows with the force, by newtons / u, and never shrinks.
///
/// Not thread-safe: one per stream.
class MaterialMemory {
 public:
  /// `law` must be consistent.
  MaterialMemory(const MemoryLaw& law, std::size_t taxels);

  /// newtons, sigma_newtons and sums of a frame of the array's size. `noise_newtons`: ForceFusion::noise_newtons() of
  /// the same frame. Allocates nothing.
  void process(ForceFrame& force, std::span<const float> noise_newtons) noexcept;

  using Approach = std::array<double, MemoryLaw::kCreepSeconds.size()>;

  /// a_k of an interval between frames.
  [[nodiscard]] static Approach approach(Nanos interval) noexcept;

  /// The same for bare forces [taxels], after an interval of this approach. Empty: they are the first of a recording.
  void process(std::span<float> newtons, const std::optional<Approach>& approach) noexcept;

 private:
  void forget() noexcept;
  [[nodiscard]] MemoryStep step(const Approach& approach) noexcept;

  MemoryLaw law_;
  std::optional<Nanos> time_;  // of the frame before
  std::size_t taxels_;
  std::vector<float> states_;  // f, ln(1 + f), s_k, m_j of each taxel
};

}  // namespace dermis::touch::fusion
