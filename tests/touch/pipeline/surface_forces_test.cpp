// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/surface_forces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/reference_array.hpp"

namespace dermis::touch::pipeline {
namespace {

ArrayDescription covered() {
  ArrayDescription array = support::reference_circuit(10, 10);
  array.row_pitch_m = array.col_pitch_m = 0.010;
  array.cover = Cover{0.005, {}};
  return array;
}

/// What the taxels feel, with 1 % of noise and 5 mN more.
ForceFrame felt_frame(const ArrayDescription& array, const std::vector<double>& surface, std::uint64_t seed) {
  std::vector<double> felt(surface.size());
  CoverKernel(array).spread(std::span<const double>(surface), std::span<double>(felt));
  Random random(seed);
  ForceFrame force;
  force.taxels.assign(surface.size(), TaxelStatus::ok);
  for (const double newtons : felt) {
    const double sigma = 0.005 + 0.01 * newtons;
    force.newtons.push_back(static_cast<float>(std::max(0.0, newtons + sigma * random.normal())));
    force.sigma_newtons.push_back(static_cast<float>(sigma));
  }
  return force;
}

TEST(SurfaceForces, give_a_weight_back_to_the_taxel_on_which_it_stood) {
  const ArrayDescription array = covered();
  std::vector<double> surface(100);
  surface[44] = 10.0;
  SurfaceForces surfaces(array);
  const ForceFrame& sharp = surfaces.process(felt_frame(array, surface, 1));
  EXPECT_NEAR(sharp.newtons[44], 10.0, 0.7);
  EXPECT_LT(sharp.newtons[45], 0.5F);
  EXPECT_LT(sharp.newtons[55], 0.3F);
}

TEST(SurfaceForces, are_as_sure_as_they_say) {
  const ArrayDescription array = covered();
  SurfaceForces surfaces(array);
  Random random(5);
  double within = 0.0;
  double within_two = 0.0;
  double count = 0.0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    std::vector<double> surface(100);
    const double row = random.uniform(2.0, 7.0);
    const double col = random.uniform(2.0, 7.0);
    const double size = random.uniform(0.6, 2.0);
    for (std::size_t k = 0; k < 100; ++k) {
      const std::size_t taxel_row = k / 10;
      const double square =
          std::pow(static_cast<double>(taxel_row) - row, 2) + std::pow(static_cast<double>(k % 10) - col, 2);
      surface[k] = square < 9.0 ? 10.0 * std::exp(-0.5 * square / (size * size)) : 0.0;
    }
    const ForceFrame& sharp = surfaces.process(felt_frame(array, surface, seed));
    for (std::size_t k = 0; k < 100; ++k) {
      if (surface[k] < 1.0) continue;
      const double sigmas = std::abs(sharp.newtons[k] - surface[k]) / sharp.sigma_newtons[k];
      within += sigmas < 1.0 ? 1.0 : 0.0;
      within_two += sigmas < 2.0 ? 1.0 : 0.0;
      count += 1.0;
    }
  }
  EXPECT_GT(within / count, 0.6);
  EXPECT_GT(within_two / count, 0.9);
}

TEST(SurfaceForces, keep_what_is_not_known_and_what_is_not_pressed) {
  const ArrayDescription array = covered();
  ForceFrame force = felt_frame(array, std::vector<double>(100), 3);
  force.newtons[3] = std::numeric_limits<float>::quiet_NaN();
  force.sigma_newtons[4] = std::numeric_limits<float>::infinity();
  force.newtons[4] = 50.0F;
  SurfaceForces surfaces(array);
  const ForceFrame& sharp = surfaces.process(force);
  EXPECT_TRUE(std::isnan(sharp.newtons[3]));
  EXPECT_EQ(sharp.newtons[4], 50.0F);
  EXPECT_LT(sharp.newtons[50], 0.02F);
}

TEST(SurfaceForces, allocate_nothing_after_the_first_frame) {
  const ArrayDescription array = covered();
  std::vector<double> surface(100);
  surface[44] = 10.0;
  const ForceFrame one = felt_frame(array, surface, 1);
  surface[71] = 5.0;
  const ForceFrame other = felt_frame(array, surface, 2);
  SurfaceForces surfaces(array);
  surfaces.process(one);
  const support::AllocationGuard guard;
  surfaces.process(other);
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace dermis::touch::pipeline
