// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "recognition/features/image_analysis.hpp"

namespace dermis::recognition {

/// The form of the contact whichever way it is turned: the image on rings around the centre of force, and the sizes of
/// its Fourier components round each ring. Not thread-safe.
class PolarBlock {
 public:
  static constexpr std::size_t kRings = 8;
  static constexpr std::size_t kAngles = 32;
  static constexpr std::size_t kHarmonics = 7;  ///< 0 to 6
  static constexpr std::size_t kSize = kRings * kHarmonics;

  PolarBlock();

  /// `out`: [rings, harmonics]
  void write(const ImageAnalysis& analysis, std::span<double> out);

 private:
  std::array<double, kAngles> cosine_{};
  std::array<double, kAngles> sine_{};
  std::array<double, kAngles> ring_{};
};

}  // namespace dermis::recognition
