// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "learn/recognition/features/circle.hpp"
#include "learn/recognition/features/connected_areas.hpp"
#include "learn/recognition/features/feature_group.hpp"
#include "learn/recognition/features/image_analysis.hpp"

namespace dermis::learn::recognition {

/// Size and form of the contact, wherever it is and whichever way it is turned. Not thread-safe.
class FormBlock {
 public:
  /// `least_reading`: where logarithms begin.
  FormBlock(const Lattice& lattice, double least_reading);

  [[nodiscard]] static std::vector<FeatureGroup> groups();
  /// `out`: the features of all groups
  void write(const ImageAnalysis& analysis, std::span<double> out);

 private:
  static const std::array<FeatureRow<FormBlock, ImageAnalysis>, 11> kRows;
  static constexpr std::size_t kDirections = 16;

  void put_areas(const ImageAnalysis& analysis, std::span<double> out);
  void put_quantiles(std::span<const double> root, std::span<double> out);
  void put_directions(const ImageAnalysis& analysis, std::span<double> out) const;
  void put_textures(const ImageAnalysis& analysis, std::span<double> out);

  double least_reading_;
  ConnectedAreas areas_;
  GaussianBlur medium_;
  GaussianBlur coarse_;
  Circle<kDirections> directions_;
  std::vector<double> sorted_;
  std::vector<double> blurred_;
  std::vector<double> blurred_more_;
};

}  // namespace dermis::learn::recognition
