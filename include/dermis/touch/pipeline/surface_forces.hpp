// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/cover.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::pipeline {

/// Finds the forces on the cover of an array by those that its taxels feel. Many surface forces explain felt ones
/// within their noise. So each is the felt one and a deviation in proportion to it, whose size follows from the frame
/// (Bayes, evidence); none is below 0. Taxels that feel nothing carry nothing. Takes pressed^3 operations; where more
/// than 1024 taxels are pressed, forces stay as they are felt. Not thread-safe.
class SurfaceForces {
 public:
  /// The cover of `array` is known.
  explicit SurfaceForces(const ArrayDescription& array);

  /// `force` with the forces on the surface and their standard deviations, which say what sharpening costs. Where a
  /// taxel has no force, or none with an upper bound, the surface has the same there. Sums stay those of the taxels.
  /// Allocates nothing after the first call.
  const ForceFrame& process(const ForceFrame& force) noexcept;

 private:
  void choose_pressed(const ForceFrame& force);
  void weigh();
  /// The deviations that are most likely where their relative size is `size`; returns the size that they show.
  double solve(double size);
  void invert();
  void take(const ForceFrame& force);
  [[nodiscard]] double share(std::size_t a, std::size_t b) const noexcept;

  std::size_t cols_;
  CoverKernel kernel_;
  std::vector<std::size_t> pressed_;  // [n] taxels
  std::vector<double> felt_;          // [n]
  std::vector<double> precision_;     // [n] of the felt forces: 1 / variance
  std::vector<double> normal_;        // [n, n] K W K
  std::vector<double> matrix_;        // [n, n] its factor, then its inverse
  std::vector<double> gradient_;      // [n] K W (f - K f)
  std::vector<double> deviation_;     // [n] of the surface from the felt forces
  ForceFrame surface_;
};

}  // namespace dermis::touch::pipeline
