// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "touch/contacts/patch_response.hpp"

namespace dermis::touch::contacts {

/// Distances between taxels, and the spread of a cover, in radii of a taxel.
struct TaxelSpacing {
  double col_pitch = 2.857;
  double row_pitch = 2.857;
  double cover_spread = 0.0;

  bool operator==(const TaxelSpacing&) const = default;
};

/// The shape of a contact on one to four taxels. These are the strongest, the stronger of its two neighbours in row and
/// column, and the taxel diagonal to it between these. All others show nothing. The values are shares of the strongest
/// force.
struct SmallContact {
  float across = 0.0F;
  float down = 0.0F;
  float diagonal = 0.0F;
  float noise = 0.0F;  ///< Standard deviation of an unpressed taxel.
};

/// Where it is, towards the neighbours across and down from the strongest taxel; lengths in radii of a taxel.
struct SmallContactPlace {
  float x = 0.0F;
  float y = 0.0F;
  float variance_x = 0.0F;
  float variance_y = 0.0F;
  float log_radius = 0.0F;
};

/// Up to four taxels do not determine place, radius and force of a patch. Many patches fit them alike, and the most
/// likely one may be at the end of the possible range. So this gives the mean and the variance over all round patches
/// that would show the same, Hertz and flat ones, tabulated for an array. All radii from a tenth of a pitch to two
/// count alike.
class SmallContactTable {
 public:
  /// Tables are shared by arrays of the same spacing that a thread asks for. Thread-safe.
  [[nodiscard]] static std::shared_ptr<const SmallContactTable> of(const TaxelSpacing& spacing,
                                                                   const PatchResponses& responses);

  SmallContactTable(const TaxelSpacing& spacing, const PatchResponses& responses);

  /// Empty where no round patch shows anything like it.
  [[nodiscard]] std::optional<SmallContactPlace> find(const SmallContact& contact) const noexcept;

 private:
  static constexpr std::size_t kAcross = 13;  // knots of the root of a share, from 0 to 1
  static constexpr std::size_t kDiagonal = 9;
  static constexpr std::size_t kNoises = 5;
  static constexpr float kLeastNoise = 3e-4F;
  static constexpr float kNoisesPerDecade = 2.0F;
  static constexpr std::size_t kKnots = kAcross * kAcross * kDiagonal;
  static constexpr std::size_t kValues = 8;  // weight, x, y, x^2, y^2 and log radius, then nothing

  /// Shares of a patch's force on the taxels around the strongest, from one up and left of it to two down and right.
  struct Sample {
    float x = 0.0F;
    float y = 0.0F;
    float log_radius = 0.0F;
    float weight = 0.0F;
    float across = 0.0F;
    float down = 0.0F;
    float diagonal = 0.0F;
    float others = 0.0F;  // sum of squares
  };
  using Knot = std::array<float, kValues>;

  void add_samples(const TaxelSpacing& spacing, const PatchResponses& responses);
  /// Fills the shares; false where the first taxel would not be the strongest.
  static bool respond(const TaxelSpacing& spacing, const PatchResponse::Row& response, Sample& sample);
  void add(const Sample& sample);
  void normalise();

  std::vector<Knot> knots_;  // [kNoises, across, down, diagonal]
};

}  // namespace dermis::touch::contacts
