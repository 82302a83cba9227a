// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/random.hpp"

// Pressure on round taxels by sums over many small pieces of each: slow, and shares nothing with the code that it
// judges.
namespace dermis::support {

enum class Profile { hertz, flat };

/// An elliptical patch of pressure; round where both half axes are equal.
struct PressurePatch {
  double x = 0.0;  ///< Centre [m].
  double y = 0.0;
  double half_axis_m = 0.01;
  double other_half_axis_m = 0.01;
  double angle_rad = 0.0;  ///< Of the first half axis against x.
  double newtons = 10.0;   ///< In all, between the taxels too.
  Profile profile = Profile::hertz;

  [[nodiscard]] double pressure(double at_x, double at_y) const {
    const double along = (at_x - x) * std::cos(angle_rad) + (at_y - y) * std::sin(angle_rad);
    const double across = (at_y - y) * std::cos(angle_rad) - (at_x - x) * std::sin(angle_rad);
    const double squared = std::pow(along / half_axis_m, 2) + std::pow(across / other_half_axis_m, 2);
    if (squared >= 1.0) return 0.0;
    const double mean = newtons / (std::numbers::pi * half_axis_m * other_half_axis_m);
    return profile == Profile::flat ? mean : 1.5 * mean * std::sqrt(1.0 - squared);
  }
};

inline PressurePatch round_patch(double x, double y, double diameter_m, double newtons,
                                 Profile profile = Profile::hertz) {
  return {x, y, diameter_m / 2.0, diameter_m / 2.0, 0.0, newtons, profile};
}

/// Force on a disc of 7 mm around (x, y): a grid of 0.1 mm.
inline double force_on_disc(const PressurePatch& patch, double x, double y) {
  constexpr double kRadius = 3.5e-3;
  constexpr int kSteps = 70;
  constexpr double kStep = 2.0 * kRadius / kSteps;
  const double reach = std::max(patch.half_axis_m, patch.other_half_axis_m) + kRadius;
  if (std::hypot(x - patch.x, y - patch.y) > reach) return 0.0;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    for (int k = 0; k < kSteps; ++k) {
      const double dx = (i + 0.5) * kStep - kRadius;
      const double dy = (k + 0.5) * kStep - kRadius;
      if (dx * dx + dy * dy < kRadius * kRadius) sum += patch.pressure(x + dx, y + dy);
    }
  }
  return sum * kStep * kStep;
}

/// True force on each taxel [N].
inline std::vector<double> taxel_forces(const ArrayDescription& array, const std::vector<PressurePatch>& patches) {
  std::vector<double> newtons(array.taxel_count());
  for (std::size_t taxel = 0; taxel < newtons.size(); ++taxel) {
    const std::size_t row = taxel / array.cols;
    const double x = static_cast<double>(taxel % array.cols) * array.col_pitch_m;
    const double y = static_cast<double>(row) * array.row_pitch_m;
    for (const PressurePatch& patch : patches) newtons[taxel] += force_on_disc(patch, x, y);
  }
  return newtons;
}

/// What a calibrated pipeline makes of them: an error of 1 % and of 0.02 N, both normal and stated as the 1-sigma.
inline ForceFrame measured_forces(const std::vector<double>& newtons, Random& random) {
  constexpr double kFloor = 0.02;
  constexpr double kShare = 0.01;
  ForceFrame frame;
  frame.taxels.assign(newtons.size(), TaxelStatus::ok);
  for (const double force : newtons) {
    const double sigma = std::hypot(kFloor, kShare * force);
    const double measured = force + sigma * random.normal();
    frame.newtons.push_back(static_cast<float>(std::max(0.0, measured)));
    frame.sigma_newtons.push_back(static_cast<float>(sigma));
    frame.signal_to_noise.push_back(static_cast<float>(measured / kFloor));
  }
  return frame;
}

}  // namespace dermis::support
