// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "learn/recognition/features/circle.hpp"
#include "learn/recognition/features/feature_group.hpp"
#include "learn/recognition/features/image_analysis.hpp"

namespace dermis::learn::recognition {

/// The form of the contact whichever way it is turned. It takes the image on rings around the centre of force, and the
/// sizes of its Fourier components round each ring. Not thread-safe.
class PolarBlock {
 public:
  PolarBlock();

  [[nodiscard]] static FeatureGroup group() noexcept {
    return {"rings around the centre", FeatureAspect::shape, kRings * kHarmonics};
  }
  /// `out`: [rings, harmonics]
  void write(const ImageAnalysis& analysis, std::span<double> out);

 private:
  static constexpr std::size_t kRings = 8;
  static constexpr std::size_t kAngles = 32;
  static constexpr std::size_t kHarmonics = 7;  ///< 0 to 6

  Circle<kAngles> angles_;
  Eigen::Matrix<double, kHarmonics, kAngles> real_;  ///< Of the Fourier components.
  Eigen::Matrix<double, kHarmonics, kAngles> imaginary_;
  Eigen::Matrix<double, kAngles, 1> ring_;
};

}  // namespace dermis::learn::recognition
