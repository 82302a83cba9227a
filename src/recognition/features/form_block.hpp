// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "recognition/features/connected_areas.hpp"
#include "recognition/features/image_analysis.hpp"

namespace dermis::recognition {

/// Size and form of the contact, wherever it is and whichever way it is turned. Not thread-safe.
class FormBlock {
 public:
  static constexpr std::size_t kSize = 46;
  /// Places of the features that tell of the force, and of the area of the contact; the others tell of its shape.
  static constexpr std::array<std::size_t, 2> kForcePlaces{0, 1};
  static constexpr std::array<std::size_t, 12> kAreaPlaces{3, 4, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31};

  /// `least_reading`: where logarithms begin.
  FormBlock(const Lattice& lattice, double least_reading);

  void write(const ImageAnalysis& analysis, std::span<double> out);

 private:
  static constexpr std::size_t kDirections = 16;

  void put_areas(const ImageAnalysis& analysis, std::span<double> out);
  void put_quantiles(std::span<const double> root, std::span<double> out);
  void put_directions(const ImageAnalysis& analysis, std::span<double> out) const;
  void put_textures(const ImageAnalysis& analysis, std::span<double> out);

  double least_reading_;
  ConnectedAreas areas_;
  GaussianBlur medium_;
  GaussianBlur coarse_;
  std::array<double, kDirections> cosine_{};
  std::array<double, kDirections> sine_{};
  std::vector<double> sorted_;
  std::vector<double> blurred_;
  std::vector<double> blurred_more_;
};

}  // namespace dermis::recognition
