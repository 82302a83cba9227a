// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/force_sums.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis {
namespace {

constexpr float kNoForce = std::numeric_limits<float>::quiet_NaN();

/// Whose variance is (sum of weight * siemens)^2: one factor is wrong for all.
class OneFactor final : public CircuitErrors {
 public:
  void variances(const ConductanceErrors& errors, std::span<const WeightedConductances> sums,
                 std::span<double> variances) const noexcept override {
    for (std::size_t k = 0; k < sums.size(); ++k) variances[k] = std::pow(weighted(errors, sums[k]), 2);
  }

 private:
  static double weighted(const ConductanceErrors& errors, const WeightedConductances& sum) {
    double weighted = 0.0;
    for (std::size_t k = 0; k < sum.taxels.size(); ++k) {
      weighted += sum.weight[k] * static_cast<double>(errors.siemens[sum.taxels[k]]);
    }
    return weighted;
  }
};

/// Three taxels, the middle one with noise below zero.
ForceFrame signed_frame() {
  ForceFrame force;
  force.newtons = {3.0F, 0.0F, 1.0F};
  force.sigma_newtons = {1.0F, 1.0F, 1.0F};
  force.sums.newtons = {3.0F, -0.5F, 1.0F};
  force.sums.own_variance = {0.09F, 0.16F, 0.0F};
  force.sums.newtons_per_siemens = {1.0F, 2.0F, 3.0F};
  force.sums.newtons_per_celsius = {0.0F, 0.0F, 0.0F};
  return force;
}

TEST(ForceSums, noise_below_zero_counts) {
  const TotalForce total = signed_frame().total();
  EXPECT_DOUBLE_EQ(total.newtons, 3.5);
  EXPECT_NEAR(total.sigma_newtons, 0.5, 1e-7);
  EXPECT_EQ(total.left_out, 0U);
}

/// Variance of the sum of two taxels of 3 and 1 N whose gains are each wrong by 10 %.
double variance_of_pair(std::size_t first, std::size_t second, const GainErrors& shares) {
  GainErrors errors = shares;
  errors.sigma.assign(6, 0.1F);
  errors.cols = 3;
  std::vector<float> newtons(6);
  newtons[first] = 3.0F;
  newtons[second] = 1.0F;
  return errors.variance(newtons, std::vector<std::size_t>{first, second});
}

TEST(GainErrors, add_up_where_a_line_shares_them) {
  const GainErrors own;
  GainErrors rows;
  rows.row_share = 1.0;
  GainErrors columns;
  columns.column_share = 1.0;
  GainErrors sheet;
  sheet.sheet_share = 1.0;
  GainErrors mixed;
  mixed.sheet_share = mixed.row_share = mixed.column_share = 0.25;
  const std::size_t in_row = 1;
  const std::size_t in_column = 3;
  EXPECT_NEAR(variance_of_pair(0, in_row, own), 0.1, 1e-7);
  EXPECT_NEAR(variance_of_pair(0, in_row, rows), 0.16, 1e-7);
  EXPECT_NEAR(variance_of_pair(0, in_column, rows), 0.1, 1e-7);
  EXPECT_NEAR(variance_of_pair(0, in_column, columns), 0.16, 1e-7);
  EXPECT_NEAR(variance_of_pair(0, in_row, columns), 0.1, 1e-7);
  EXPECT_NEAR(variance_of_pair(0, 4, sheet), 0.16, 1e-7);
  EXPECT_NEAR(variance_of_pair(0, in_row, mixed), 0.13, 1e-7);
}

TEST(ForceSums, errors_of_gains_widen_the_total) {
  ForceFrame force = signed_frame();
  auto errors = std::make_shared<GainErrors>();
  errors->sigma = {0.1F, 0.1F, 0.1F};
  errors->cols = 3;
  errors->row_share = 1.0;
  force.sums.gains = errors;
  EXPECT_NEAR(std::pow(force.total().sigma_newtons, 2), 0.25 + std::pow(0.1 * 3.5, 2), 1e-6);
}

TEST(ForceSums, a_region_is_the_sum_of_its_taxels) {
  const std::vector<std::size_t> taxels{2, 1};
  const TotalForce total = signed_frame().total(taxels);
  EXPECT_DOUBLE_EQ(total.newtons, 0.5);
  EXPECT_NEAR(total.sigma_newtons, 0.4, 1e-7);
  EXPECT_EQ(signed_frame().total(std::vector<std::size_t>{}), TotalForce{});
}

TEST(ForceSums, an_error_that_taxels_share_adds_up_before_it_is_squared) {
  ForceFrame force = signed_frame();
  force.sums.own_variance.assign(3, 0.0F);
  force.sums.newtons_per_celsius = {0.1F, 0.2F, 0.3F};
  force.sums.temperature_sigma = 0.5;
  EXPECT_NEAR(force.total().sigma_newtons, 0.3, 1e-7);
  force.sums.newtons_per_celsius = {0.1F, 0.2F, -0.3F};
  EXPECT_NEAR(force.total().sigma_newtons, 0.0, 1e-7);
  force.sums.gain_sigma = 0.02;
  EXPECT_NEAR(force.total().sigma_newtons, 0.07, 1e-7);
}

TEST(ForceSums, the_circuit_sees_the_region_alone) {
  ForceFrame force = signed_frame();
  force.sums.own_variance.assign(3, 0.0F);
  force.sums.conductances.siemens = {1.0F, 1.0F, 1.0F};
  force.sums.conductances.circuit = std::make_shared<const OneFactor>();
  EXPECT_NEAR(force.total().sigma_newtons, 6.0, 1e-7);
  const std::vector<std::size_t> taxels{0, 1};
  EXPECT_NEAR(force.total(taxels).sigma_newtons, 3.0, 1e-7);
}

TEST(ForceSums, several_regions_at_once_are_as_each_alone) {
  ForceFrame force = signed_frame();
  force.sums.conductances.siemens = {1.0F, 1.0F, 1.0F};
  force.sums.conductances.circuit = std::make_shared<const OneFactor>();
  const std::vector<std::size_t> some{2, 0};
  const std::vector<std::size_t> none;
  const std::vector<std::size_t> one{1};
  const std::vector<std::span<const std::size_t>> regions{some, none, one};
  std::vector<TotalForce> totals(3);
  force.find_totals(regions, totals);
  for (std::size_t k = 0; k < regions.size(); ++k) EXPECT_EQ(totals[k], force.total(regions[k])) << k;
}

TEST(ForceSums, noise_without_a_circuit_is_independent) {
  ForceFrame force = signed_frame();
  force.sums.own_variance.assign(3, 0.0F);
  force.sums.conductances.noise_siemens = {0.2F, 0.2F, 0.1F};
  EXPECT_NEAR(force.total().sigma_newtons, std::sqrt(0.04 + 0.16 + 0.09), 1e-7);
}

TEST(ForceSums, taxels_without_a_force_are_left_out_and_counted) {
  ForceFrame force = signed_frame();
  force.sums.newtons[0] = kNoForce;
  const TotalForce total = force.total();
  EXPECT_DOUBLE_EQ(total.newtons, 0.5);
  EXPECT_EQ(total.left_out, 1U);
  EXPECT_NEAR(total.sigma_newtons, 0.4, 1e-7);
}

TEST(ForceSums, where_all_are_left_out_there_is_no_sum) {
  ForceFrame force = signed_frame();
  force.sums.newtons.assign(3, kNoForce);
  EXPECT_TRUE(std::isnan(force.total().newtons));
  EXPECT_TRUE(std::isnan(force.total().sigma_newtons));
  EXPECT_EQ(force.total().left_out, 3U);
}

TEST(ForceSums, a_force_without_an_upper_bound_leaves_none_to_the_sum) {
  ForceFrame force = signed_frame();
  force.sums.own_variance[2] = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(std::isinf(force.total().sigma_newtons));
  EXPECT_DOUBLE_EQ(force.total().newtons, 3.5);
}

TEST(ForceSums, a_frame_without_signed_forces_sums_what_it_has) {
  ForceFrame force;
  force.newtons = {3.0F, kNoForce, 1.0F};
  force.sigma_newtons = {0.3F, kNoForce, 0.4F};
  const TotalForce total = force.total();
  EXPECT_DOUBLE_EQ(total.newtons, 4.0);
  EXPECT_NEAR(total.sigma_newtons, 0.5, 1e-7);
  EXPECT_EQ(total.left_out, 1U);
}

}  // namespace
}  // namespace dermis
