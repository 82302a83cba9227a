// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/patch_fit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace dermis::touch::contacts {
namespace {

const PatchPrior kPrior{std::log(2.1F), 0.6F};
constexpr float kPitch = 2.857F;

/// Taxels of 4 x 4 under a patch without noise, each known to `relative` of its force and `least_n`.
std::vector<FitTaxel> taxels_under(const Patch& patch, PatchProfile profile, float relative, float least_n) {
  const PatchResponse::Row response = PatchResponses::of(0.0)->of(profile).row(patch.log_radius);
  std::vector<FitTaxel> taxels;
  for (int row = -1; row <= 2; ++row) {
    for (int col = -1; col <= 2; ++col) {
      const float x = static_cast<float>(col) * kPitch;
      const float y = static_cast<float>(row) * kPitch;
      const float newtons = patch.newtons * response.share(std::hypot(x - patch.x, y - patch.y));
      taxels.push_back({x, y, newtons, 1.0F / std::hypot(least_n, relative * newtons)});
    }
  }
  return taxels;
}

/// Chi squared of the best force at a place and radius, and its second derivative by the force.
std::array<double, 3> best_force(const std::vector<FitTaxel>& taxels, PatchProfile profile, double x, double y,
                                 double log_radius) {
  const PatchResponse::Row response = PatchResponses::of(0.0)->of(profile).row(static_cast<float>(log_radius));
  double square = 0.0;
  double product = 0.0;
  double all = 0.0;
  for (const FitTaxel& taxel : taxels) {
    const double share = taxel.weight * response.share(static_cast<float>(std::hypot(taxel.x - x, taxel.y - y)));
    const double measured = taxel.weight * taxel.newtons;
    square += share * share;
    product += share * measured;
    all += measured * measured;
  }
  return {product / square, square, all - product * product / square};
}

TEST(PatchFit, finds_the_patch_that_presses) {
  const Patch patch{0.7F, 1.1F, std::log(5.0F), 12.0F};
  for (const PatchProfile profile : {PatchProfile::hertz, PatchProfile::flat}) {
    const PatchFit fit = fit_patch(taxels_under(patch, profile, 0.01F, 0.01F), *PatchResponses::of(0.0), profile,
                                   {0.3F, 0.5F, std::log(3.5F), 1.0F}, kPrior);
    EXPECT_NEAR(fit.patch.x, patch.x, 0.02F);
    EXPECT_NEAR(fit.patch.y, patch.y, 0.02F);
    EXPECT_NEAR(fit.patch.log_radius, patch.log_radius, 0.02F);
    EXPECT_NEAR(fit.patch.newtons, patch.newtons, 0.5F);
  }
}

TEST(MeanOverRadii, is_that_of_all_patches_each_by_its_likelihood) {
  const Patch patch{0.8F, 0.9F, std::log(2.4F), 5.0F};
  const std::vector<FitTaxel> taxels = taxels_under(patch, PatchProfile::hertz, 0.02F, 0.02F);
  double weight = 0.0;
  std::array<double, 5> sums{};  // x, y, their squares, ln radius
  for (double log_radius = std::log(1.0); log_radius < std::log(6.0); log_radius += 0.02) {
    for (double x = -0.5; x < 2.5; x += 0.02) {
      for (double y = -0.5; y < 2.5; y += 0.02) {
        const auto [newtons, square, chi_squared] = best_force(taxels, PatchProfile::hertz, x, y, log_radius);
        const double off = (log_radius - kPrior.log_radius) / kPrior.sigma;
        const double likelihood = std::exp(-0.5 * (chi_squared + off * off)) / (newtons * std::sqrt(square));
        weight += likelihood;
        sums[0] += likelihood * x;
        sums[1] += likelihood * y;
        sums[2] += likelihood * x * x;
        sums[3] += likelihood * y * y;
        sums[4] += likelihood * log_radius;
      }
    }
  }
  for (double& sum : sums) sum /= weight;
  const PatchFit fit = fit_patch(taxels, *PatchResponses::of(0.0), PatchProfile::hertz, patch, kPrior);
  const PatchFit mean = mean_over_radii(taxels, *PatchResponses::of(0.0), fit, kPrior);
  const double sigma_x = std::sqrt(sums[2] - sums[0] * sums[0]);
  const double sigma_y = std::sqrt(sums[3] - sums[1] * sums[1]);
  EXPECT_NEAR(mean.patch.x, sums[0], 0.2 * sigma_x);
  EXPECT_NEAR(mean.patch.y, sums[1], 0.2 * sigma_y);
  EXPECT_NEAR(mean.patch.log_radius, sums[4], 0.05);
  EXPECT_NEAR(std::sqrt(mean.variance_x), sigma_x, 0.2 * sigma_x);
  EXPECT_NEAR(std::sqrt(mean.variance_y), sigma_y, 0.2 * sigma_y);
}

TEST(MeanOfProfiles, covers_both_that_fit_alike_and_leaves_one_that_does_not) {
  PatchFit hertz;
  hertz.patch = {1.0F, 2.0F, 0.5F, 3.0F};
  hertz.variance_x = hertz.variance_y = 0.01F;
  hertz.chi_squared = 4.0F;
  PatchFit flat = hertz;
  flat.profile = PatchProfile::flat;
  flat.patch.x = 2.0F;
  const PatchFit both = mean_of_profiles(hertz, flat);
  EXPECT_FLOAT_EQ(both.patch.x, 1.5F);
  EXPECT_FLOAT_EQ(both.patch.y, 2.0F);
  EXPECT_FLOAT_EQ(both.variance_x, 0.01F + 0.25F);
  EXPECT_FLOAT_EQ(both.variance_y, 0.01F);
  flat.chi_squared = 80.0F;
  const PatchFit one = mean_of_profiles(flat, hertz);
  EXPECT_EQ(one.profile, PatchProfile::hertz);
  EXPECT_FLOAT_EQ(one.patch.x, 1.0F);
  EXPECT_FLOAT_EQ(one.variance_x, 0.01F);
}

}  // namespace
}  // namespace dermis::touch::contacts
