// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::contacts {

/// Finds the pressed taxels of a frame that hang together (8 neighbours), and parts them at the valleys between peaks.
///
/// Taxels are taken by falling force. One with no neighbour that was taken before begins an area, any other one joins
/// that of its strongest neighbour. Two areas that meet become one unless the lower peak stands out of the meeting
/// point. It must do so by noise (kValleySigma) and by a share of itself (kValleyShare). The peak must also show a
/// higher signal: a valley of the forces alone may come from the calibration of unlike taxels. The first two count half
/// (kHeldShare) between two areas that hold a contact each already. Taxels without force carry the lower of two
/// opposite neighbours, so that a dead line does not cut an area across it. They belong to no area.
class StressedAreas {
 public:
  static constexpr float kValleySigma = 4.0F;
  static constexpr float kValleyShare = 0.1F;
  static constexpr float kHeldShare = 0.5F;  ///< Keeps contacts apart that are there already.

  /// `overlapping`: each taxel feels loads beside it, so that a valley of the forces parts no contacts.
  StressedAreas(std::size_t rows, std::size_t cols, bool overlapping);

  /// A taxel is pressed from `sigma` standard deviations of the additive noise on.
  /// `held`: the taxels nearest to the contacts of the frame before.
  void find(const ForceFrame& force, double sigma, std::span<const std::uint32_t> held);

  /// The taxels of each area, by falling force; the next find() overwrites them.
  [[nodiscard]] std::span<const std::span<std::uint32_t>> areas() const noexcept { return areas_; }

 private:
  struct Pressed {
    float newtons = 0.0F;
    float sigma = 0.0F;  // 0 where it is not finite
    float signal = 0.0F;
    std::uint32_t taxel = 0;
    std::int32_t peak = 0;  // of its area: index into peaks_
    bool has_force = false;
  };
  struct Peak {
    float newtons = 0.0F;
    float sigma = 0.0F;
    float signal = 0.0F;
    std::int32_t higher = 0;  // that took this one over; itself where none did
    std::int32_t held = 0;    // index into held, kNone
    std::uint32_t count = 0;
    std::uint32_t first = 0;  // in taxels_
  };

  void collect(const ForceFrame& force, float sigma);
  void collect_one(const ForceFrame& force, std::size_t taxel, float sigma);
  [[nodiscard]] float bridged_newtons(const ForceFrame& force, std::size_t taxel) const noexcept;
  void grow(std::span<const std::uint32_t> held);
  void begin_area(Pressed& pressed, std::span<const std::uint32_t> held);
  void meet(std::int32_t a, std::int32_t b, const Pressed& valley);
  void group();
  [[nodiscard]] std::int32_t top(std::int32_t peak) const noexcept;
  [[nodiscard]] std::int32_t nearest(std::uint32_t taxel, std::span<const std::uint32_t> held) const noexcept;
  [[nodiscard]] std::size_t place(std::size_t taxel) const noexcept {
    return (taxel / cols_ + 1) * (cols_ + 2) + taxel % cols_ + 1;
  }

  std::size_t rows_;
  std::size_t cols_;
  bool overlapping_;
  std::vector<Pressed> pressed_;        // by falling force
  std::vector<std::int32_t> order_at_;  // [rows + 2, cols + 2]: index into pressed_, kNone
  std::vector<Peak> peaks_;
  std::vector<std::uint32_t> taxels_;
  std::vector<std::span<std::uint32_t>> areas_;
};

}  // namespace dermis::touch::contacts
