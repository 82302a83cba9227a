// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/learn/recognition/segment.hpp"
#include "learn/recognition/features/feature_group.hpp"
#include "learn/recognition/features/image_analysis.hpp"
#include "learn/recognition/features/regrid.hpp"

namespace dermis::learn::recognition {

/// Taxels of all arrays.
[[nodiscard]] std::size_t taxels_of(const Layout& layout);

/// Features of each taxel of one array: which ones are pressed, and how their readings go on. Not thread-safe.
class TaxelBlock {
 public:
  /// Images come on `lattice`. The features are of the taxels of `examples`.
  TaxelBlock(const SensedArray& examples, const Lattice& lattice);

  [[nodiscard]] static FeatureGroup pattern_group(const Layout& layout) {
    return {"held reading of each taxel", FeatureAspect::place, taxels_of(layout)};
  }
  [[nodiscard]] static std::vector<FeatureGroup> course_groups(const Layout& layout, bool moving);

  void begin();
  void add(std::span<const double> frame);

  /// Roots of an image on the lattice, [taxels].
  void write_roots(std::span<const double> image, std::span<double> out);
  /// Roots of the mean of the frames that were added, [taxels].
  void write_mean(std::span<double> out);
  /// Roots of their deviation.
  void write_deviation(std::span<double> out);
  [[nodiscard]] std::size_t taxels() const noexcept { return taxels_; }

 private:
  std::size_t taxels_;
  Regrid regrid_;
  std::size_t frames_ = 0;
  std::vector<double> sum_;
  std::vector<double> squares_;
  std::vector<double> moment_;
  std::vector<float> image_;
};

}  // namespace dermis::learn::recognition
