// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/weight_check.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::size_t kLines = 8;
constexpr double kWeight = 5.0;
constexpr double kSigma = 0.01;  // of the force of a taxel, relative

/// An array of 8 x 8 taxels at 50 frames a second, on which an object stands on 2 x 2 taxels.
class Scale {
 public:
  Scale() : check_(support::hand_made_model(kLines, kLines), kWeight) {}
  explicit Scale(const touch::pipeline::Model& model) : check_(model, kWeight) {}

  Scale& rest(double seconds = 1.0) { return hold(0.0, seconds); }

  /// The array reads so much in all.
  Scale& hold(double newtons, double seconds) {
    for (double left = seconds; left > 0.0; left -= 0.02) add(newtons);
    return *this;
  }

  /// On its way to so much, and all of the way back.
  Scale& wave(double newtons, double seconds) {
    for (double t = 0.0; t < seconds; t += 0.02) add(newtons * (1.2 + std::sin(4.0 * t)) / 2.2);
    return *this;
  }

  [[nodiscard]] WeightFinding finding() const { return check_.finding(); }
  double sigma = kSigma;

 private:
  void add(double newtons) {
    ForceFrame force;
    force.time = time_ += std::chrono::milliseconds(20);
    force.newtons.assign(kLines * kLines, 0.0F);
    force.sigma_newtons.assign(kLines * kLines, 0.005F);
    force.signal_to_noise.assign(kLines * kLines, 0.0F);
    force.taxels.assign(kLines * kLines, TaxelStatus::ok);
    for (const std::size_t taxel : {27UL, 28UL, 35UL, 36UL}) {
      force.newtons[taxel] = static_cast<float>(newtons / 4.0 * (1.0 + 1e-3 * random_.normal()));
      if (newtons == 0.0) continue;
      force.sigma_newtons[taxel] = static_cast<float>(sigma) * force.newtons[taxel];
      force.signal_to_noise[taxel] = 500.0F;
    }
    check_.add(force);
  }

  WeightCheck check_;
  Nanos time_{};
  Random random_{1};
};

TEST(WeightCheck, an_object_that_reads_what_it_weighs_is_well) {
  const WeightFinding finding = Scale().rest().hold(4.94, 4.0).rest().finding();
  ASSERT_EQ(finding.presses.size(), 1U);
  EXPECT_NEAR(finding.presses.front().newtons, 4.94, 0.01);
  EXPECT_NEAR(finding.ratio, 0.988, 0.002);
  EXPECT_NEAR(finding.sigma, kSigma / 2.0, 1e-4);  // four taxels
  EXPECT_FALSE(finding.has_aged());
  EXPECT_EQ(describe(finding),
            "weight  5 N, put on once\nreads   4.94 N (4.94 N)\nwell: reads 1.2 % low, within 3 %\n");
}

TEST(WeightCheck, what_is_narrower_than_a_point_was_shows_a_cover_that_spreads_less) {
  touch::pipeline::Model model = support::hand_made_model(kLines, kLines);
  model.array.cover = Cover{0.010, {}};
  const WeightFinding finding = Scale(model).rest().hold(kWeight, 3.0).rest().finding();
  EXPECT_TRUE(finding.has_lost_cover());
  EXPECT_NE(describe(finding).find("recalibrate: the cover has changed, it spreads less"), std::string::npos);
}

TEST(WeightCheck, what_is_as_wide_as_a_point_was_says_nothing_of_the_cover) {
  touch::pipeline::Model model = support::hand_made_model(kLines, kLines);
  model.array.cover = Cover{0.0035, {}};
  const WeightFinding finding = Scale(model).rest().hold(kWeight, 3.0).rest().finding();
  EXPECT_FALSE(finding.has_lost_cover());
  EXPECT_EQ(describe(finding).find("cover"), std::string::npos);
}

TEST(WeightCheck, a_gain_that_has_changed_by_a_tenth_is_found_by_one_press) {
  for (const double change : {0.9, 1.1}) {
    const WeightFinding finding = Scale().rest().hold(change * kWeight, 4.0).rest().finding();
    EXPECT_TRUE(finding.has_aged());
    EXPECT_NE(describe(finding).find("recalibrate: gains have changed by about 10 % (\u00b1 1 %): it reads " +
                                     std::string(change > 1.0 ? "too much" : "too little")),
              std::string::npos)
        << describe(finding);
  }
}

TEST(WeightCheck, a_model_that_is_less_sure_needs_more_presses) {
  Scale scale;
  scale.sigma = 0.12;
  scale.rest().hold(1.1 * kWeight, 4.0).rest();
  EXPECT_FALSE(scale.finding().has_aged());
  EXPECT_NE(describe(scale.finding()).find("no change seen: reads 10.0 % high, within 18 %: put the object on again"),
            std::string::npos)
      << describe(scale.finding());
  for (int k = 0; k < 4; ++k) scale.hold(1.1 * kWeight, 4.0).rest();
  EXPECT_TRUE(scale.finding().has_aged());
}

TEST(WeightCheck, presses_that_differ_by_more_than_the_model_says_make_it_less_sure) {
  Scale scale;
  for (const double reads : {4.0, 5.0, 6.0, 6.8}) scale.rest().hold(reads, 4.0);
  const WeightFinding finding = scale.rest().finding();
  EXPECT_EQ(finding.presses.size(), 4U);
  EXPECT_GT(finding.sigma, 0.08);
  EXPECT_FALSE(finding.has_aged());
}

TEST(WeightCheck, the_hand_that_puts_it_on_does_not_count) {
  const WeightFinding finding = Scale().rest().hold(9.0, 0.9).hold(5.0, 4.0).hold(7.0, 0.5).rest().finding();
  ASSERT_EQ(finding.presses.size(), 1U);
  EXPECT_NEAR(finding.ratio, 1.0, 0.01);
}

TEST(WeightCheck, what_is_no_steady_press_of_the_weight_is_counted_apart) {
  const WeightFinding finding =
      Scale().rest().hold(5.0, 0.8).rest().wave(5.0, 4.0).rest().hold(20.0, 4.0).rest().finding();
  EXPECT_TRUE(finding.presses.empty());
  EXPECT_EQ(finding.unsteady, 2U);
  EXPECT_EQ(finding.others, 1U);
  EXPECT_FALSE(finding.has_aged());
  EXPECT_NE(describe(finding).find("1 read something else"), std::string::npos);
}

TEST(WeightCheck, the_weight_may_be_one_of_several_that_are_stacked) {
  const WeightFinding finding = Scale().rest().hold(15.0, 4.0).hold(5.1, 4.0).hold(15.0, 4.0).rest().finding();
  ASSERT_EQ(finding.presses.size(), 1U);
  EXPECT_NEAR(finding.ratio, 1.02, 0.002);
}

TEST(WeightCheck, says_what_is_missing) {
  EXPECT_EQ(describe(Scale().rest().finding()), "nothing was put on");
  EXPECT_NE(describe(Scale().rest().hold(5.0, 1.0).rest().finding()).find("lay still"), std::string::npos);
}

TEST(WeightCheck, a_press_that_lasts_counts) {
  EXPECT_EQ(Scale().rest().hold(5.0, 3.0).finding().presses.size(), 1U);
}

TEST(WeightCheck, a_force_without_an_upper_bound_weighs_nothing) {
  Scale scale;
  scale.sigma = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(scale.rest().hold(5.0, 4.0).rest().finding().presses.empty());
}

}  // namespace
}  // namespace dermis::learn::health
