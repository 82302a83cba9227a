// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace dermis::touch::contacts {

/// How the pressure of a patch of radius a falls from its centre. Under a ball on a soft ground p(r) ~ sqrt(1 -
/// r^2/a^2) (Hertz); under a flat punch or air p(r) = constant.
enum class PatchProfile { hertz, flat };

/// Share of a round patch's force that lies on a round taxel, with its slopes. It is a function of the distance between
/// their centres and of the logarithm of the patch's radius. Lengths are in radii of the taxel. A table, bilinear
/// between its knots.
class PatchResponse {
 public:
  static constexpr float kLeastRadius = 0.3F;
  static constexpr float kMostRadius = 9.0F;

  /// Under a cover that spreads the patch by a Gaussian of this standard deviation.
  PatchResponse(PatchProfile profile, double spread);

  /// Where a distance lies in the table: two pairs of neighbouring knots, each knot per_distance twice, per_log_radius
  /// and share.
  struct Cell {
    const float* lower = nullptr;
    const float* upper = nullptr;
    float right = 0.0F;  ///< Share of the second knot of each pair.
  };

  /// One radius: two rows of the table.
  class Row {
   public:
    [[nodiscard]] Cell cell(float distance) const noexcept {
      const float place =
          std::min(static_cast<float>(kDistances) - 1.001F, distance * kKnotsPerDistance);  // of NaN: the last
      const auto knot = static_cast<std::size_t>(static_cast<std::int32_t>(place));
      return {low_[knot].data(), low_[knot + kDistances].data(), place - static_cast<float>(knot)};
    }

    /// Beyond this distance a taxel has no share.
    [[nodiscard]] float reach() const noexcept { return reach_; }

    /// Share of the upper row.
    [[nodiscard]] float up() const noexcept { return up_; }

    /// Share of the patch's force.
    [[nodiscard]] float share(float distance) const noexcept {
      const Cell at = cell(distance);
      const float lower = at.lower[3] + at.right * (at.lower[7] - at.lower[3]);
      const float upper = at.upper[3] + at.right * (at.upper[7] - at.upper[3]);
      return lower + up_ * (upper - lower);
    }

   private:
    friend class PatchResponse;
    const std::array<float, 4>* low_ = nullptr;
    float up_ = 0.0F;
    float reach_ = 0.0F;
  };

  /// `log_radius` is clamped to the table.
  [[nodiscard]] Row row(float log_radius) const noexcept {
    static const float kFirst = std::log(kLeastRadius);
    const float place =
        std::max(0.0F, std::min(static_cast<float>(kRadii) - 1.001F, (log_radius - kFirst) * kKnotsPerLogRadius));
    const auto knot = static_cast<std::size_t>(place);
    Row row;
    row.low_ = knots_.data() + knot * kDistances;
    row.up_ = place - static_cast<float>(knot);
    row.reach_ = reaches_[knot + 1];
    return row;
  }

 private:
  static constexpr float kKnotsPerDistance = 12.5F;
  static constexpr float kKnotsPerLogRadius = 20.0F;
  static constexpr std::size_t kDistances = 127;
  static constexpr std::size_t kRadii = 70;

  void spread_by(double spread);
  void differentiate();

  std::vector<std::array<float, 4>> knots_;  // [kRadii, kDistances]
  std::vector<float> reaches_;               // [kRadii]: of a patch's radius and a taxel's, rounded up to a knot
};

/// The responses of all profiles under one cover.
struct PatchResponses {
  /// `spread`: as PatchResponse has it; 0: no cover. Those without a cover are computed once in a process. Thread-safe.
  [[nodiscard]] static std::shared_ptr<const PatchResponses> of(double spread);

  explicit PatchResponses(double spread) : hertz(PatchProfile::hertz, spread), flat(PatchProfile::flat, spread) {}
  [[nodiscard]] const PatchResponse& of(PatchProfile profile) const noexcept {
    return profile == PatchProfile::hertz ? hertz : flat;
  }

  PatchResponse hertz;
  PatchResponse flat;
};

}  // namespace dermis::touch::contacts
