// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "learn/recognition/features/circle.hpp"
#include "learn/recognition/features/feature_group.hpp"

namespace dermis::learn::recognition {

/// Data of one array for each frame of a segment, [frames] each. Lengths as in Lattice.
struct FrameSeries {
  std::vector<double> force;   ///< Sum of the readings.
  std::vector<double> row;     ///< Centre of force; of a frame without force that of the frame before.
  std::vector<double> col;     ///< The same along the columns.
  std::vector<double> peak;    ///< Largest reading.
  std::vector<double> area;    ///< Taxels above a tenth of the largest reading of the segment.
  std::vector<double> change;  ///< Sum of |reading - reading of the frame before|; 0 for the first.

  void resize(std::size_t frames);
  [[nodiscard]] std::size_t frames() const noexcept { return force.size(); }
};

/// How force, centre and area go on over the frames of a segment. Not thread-safe.
class TimeBlock {
 public:
  /// `least_reading`: where logarithms begin. Allocates for segments of up to `most_frames`.
  TimeBlock(double least_reading, std::size_t most_frames);

  [[nodiscard]] static std::vector<FeatureGroup> groups();
  /// `out`: the features of all groups
  void write(const FrameSeries& series, std::span<double> out);

 private:
  static const std::array<FeatureRow<TimeBlock, FrameSeries>, 12> kRows;
  static constexpr std::size_t kPeriod = 64;  ///< Points of the Fourier transform.

  void scale(const FrameSeries& series);
  void put_course(std::span<double> out) const;
  void put_path(const FrameSeries& series, std::span<double> out) const;
  void put_changes(const FrameSeries& series, std::span<double> out) const;
  void put_spectrum(std::span<const double> signal, std::span<double> out) const;
  void put_autocorrelations(std::span<double> out) const;
  void put_centre_spectrum(std::span<const double> place, std::span<double> out);

  double least_reading_;
  double peak_force_ = 0.0;
  double peak_taxel_ = 0.0;
  double peak_area_ = 0.0;
  std::vector<double> force_;  ///< Over its largest.
  std::vector<double> slope_;  ///< Differences of force_.
  std::vector<double> signal_;
  Circle<kPeriod> period_;
};

}  // namespace dermis::learn::recognition
