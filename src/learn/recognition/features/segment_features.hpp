// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/learn/recognition/segment.hpp"
#include "learn/recognition/features/feature_columns.hpp"
#include "learn/recognition/features/form_block.hpp"
#include "learn/recognition/features/hog_block.hpp"
#include "learn/recognition/features/image_analysis.hpp"
#include "learn/recognition/features/polar_block.hpp"
#include "learn/recognition/features/regrid.hpp"
#include "learn/recognition/features/taxel_block.hpp"
#include "learn/recognition/features/time_block.hpp"

namespace dermis::learn::recognition {

/// Segment -> features. Allocates only when made. Not thread-safe.
class SegmentFeatures {
 public:
  /// Makes features as for the array and rate of the `examples`, from frames of `source`, which has as many arrays and
  /// extras. The last `most_frames` (of the source) of longer segments are taken.
  SegmentFeatures(const Layout& examples, const Layout& source, bool moving, std::size_t most_frames);

  /// In the order of feature_columns(); valid until the next call. `segment` has at least one frame.
  [[nodiscard]] std::span<const double> compute(const Segment& segment);

 private:
  /// All that is computed of one array.
  struct ArrayFeatures {
    ArrayFeatures(const SensedArray& examples, const SensedArray& source, double least_reading,
                  std::size_t most_frames);

    Regrid regrid;
    Lattice lattice;
    ImageAnalysis analysis;
    HogBlock hog;
    PolarBlock polar;
    FormBlock form;
    TimeBlock time;
    std::optional<TaxelBlock> taxels;  ///< Where features tell of each taxel.
    FrameSeries series;
    std::vector<double> image;
    std::vector<double> before;
    std::vector<double> held;
    std::vector<double> changed;
  };

  void measure(const Segment& segment);
  void image_at(ArrayFeatures& array, const Segment& segment, std::size_t frame);
  void accumulate(ArrayFeatures& array, const Segment& segment);
  void write(const BlockColumns& block, const Segment& segment, std::span<double> out);
  void write_shares(std::span<double> out) const;
  void write_pattern(std::span<double> out);
  void write_course(std::span<double> out);

  Layout source_;
  bool moving_;
  std::size_t most_frames_;
  double source_frames_per_frame_;
  FeatureColumns columns_;
  std::vector<ArrayFeatures> arrays_;
  std::vector<double> force_;  ///< Of all arrays, of each frame.
  std::vector<float> blend_;   ///< A frame between two of the source.
  std::vector<double> features_;
};

}  // namespace dermis::learn::recognition
