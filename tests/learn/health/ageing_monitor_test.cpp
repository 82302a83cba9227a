// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/ageing_monitor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::size_t kLines = 16;
constexpr std::size_t kTaxels = kLines * kLines;
constexpr double kTouchSigma = 0.05;

/// Pressure at a place, over that in the centre [taxels].
using Profile = std::function<double(double x, double y)>;

Profile bell(double sigma) {
  return [=](double x, double y) { return std::exp(-(x * x + y * y) / (2.0 * sigma * sigma)); };
}

Profile ball(double radius) {
  return [=](double x, double y) { return std::sqrt(std::max(1.0 - (x * x + y * y) / (radius * radius), 0.0)); };
}

/// A sheet whose taxels read their gain times the force, and differently by 5 % at every touch.
class Sheet {
 public:
  explicit Sheet(std::uint64_t seed, double gain = 1.0, double spread = 0.0)
      : random_(seed), monitor_(support::hand_made_model(kLines, kLines)) {
    for (double& one : gains_) one = gain * std::exp(spread * random_.normal());
  }

  void touch(double row, double col, const Profile& profile) {
    std::vector<double> newtons(kTaxels);
    for (std::size_t k = 0; k < kTaxels; ++k) {
      const std::size_t line = k / kLines;
      const double y = static_cast<double>(line) - row;
      const double x = static_cast<double>(k % kLines) - col;
      newtons[k] = 10.0 * profile(x, y) * gains_[k] * std::exp(kTouchSigma * random_.normal());
    }
    for (int frame = 0; frame < 5; ++frame) add(newtons);
    add(std::vector<double>(kTaxels));
  }

  void touch_anywhere(const Profile& profile) {
    const double last = kLines - 1.0;
    touch(random_.uniform(0.0, last), random_.uniform(0.0, last), profile);
  }

  void add(const std::vector<double>& newtons, TaxelStatus status = TaxelStatus::ok) {
    ForceFrame force;
    for (const double value : newtons) {
      force.newtons.push_back(static_cast<float>(value));
      force.sigma_newtons.push_back(static_cast<float>(std::hypot(0.05 * value, 0.02)));
    }
    force.signal_to_noise.assign(kTaxels, 0.0F);
    force.taxels.assign(kTaxels, status);
    monitor_.add(force);
  }

  [[nodiscard]] AgeingEvidence evidence() const { return monitor_.evidence(); }
  [[nodiscard]] double uniform(double low, double high) { return random_.uniform(low, high); }

 private:
  Random random_;
  AgeingMonitor monitor_;
  std::vector<double> gains_ = std::vector<double>(kTaxels);
};

TEST(AgeingMonitor, gains_that_differ_by_a_tenth_are_found_within_fifty_touches) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Sheet sheet(seed, 1.0, 0.1);
    for (int k = 0; k < 50; ++k) sheet.touch_anywhere(bell(sheet.uniform(0.7, 2.5)));
    const AgeingEvidence evidence = sheet.evidence();
    EXPECT_TRUE(evidence.has_aged()) << describe(evidence);
    EXPECT_NEAR(*evidence.gain_spread, 0.1, 0.03);
    EXPECT_TRUE(describe(evidence).starts_with("recalibrate: gains have changed by about ")) << describe(evidence);
  }
}

TEST(AgeingMonitor, a_healthy_sheet_stays_healthy_over_thousands_of_touches_of_any_shape) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Sheet sheet(seed);
    for (int k = 0; k < 3000; ++k) {
      sheet.touch_anywhere(k % 2 == 0 ? bell(sheet.uniform(0.7, 2.5)) : ball(sheet.uniform(1.5, 5.0)));
      if (k % 50 == 0) {
        ASSERT_FALSE(sheet.evidence().has_aged()) << k << " touches: " << describe(sheet.evidence());
      }
    }
    EXPECT_GT(sheet.evidence().blocks, 150U);
  }
}

TEST(AgeingMonitor, a_gain_common_to_all_taxels_is_not_seen) {
  Sheet sheet(1, 1.3);
  for (int k = 0; k < 200; ++k) sheet.touch_anywhere(bell(1.5));
  EXPECT_LT(*sheet.evidence().gain_spread, 0.02);
}

TEST(AgeingMonitor, one_object_in_one_place_says_nothing_however_often_it_comes) {
  Sheet sheet(1);
  const Profile heel = [](double x, double y) { return std::abs(x) + std::abs(y) < 2.5 ? 1.0 : 0.1; };
  for (int k = 0; k < 500; ++k) sheet.touch(7.3, 8.2, heel);
  EXPECT_FALSE(sheet.evidence().has_aged()) << describe(sheet.evidence());
}

TEST(AgeingMonitor, a_model_that_promises_little_has_not_aged) {
  touch::pipeline::Model model = support::hand_made_model(4, 4);
  std::fill(model.networks.relative_sigma.begin(), model.networks.relative_sigma.end(), 0.2F);
  EXPECT_NEAR(AgeingMonitor(model).evidence().calibrated_spread, 0.2, 1e-6);
  for (std::size_t k = 0; k < model.networks.parameters.size(); ++k) {  // each taxel weighed for itself
    model.networks.parameters[k] += 1e-3F * static_cast<float>(k);
  }
  EXPECT_NEAR(AgeingMonitor(model).evidence().calibrated_spread, 0.1, 1e-6);
  AgeingEvidence evidence;
  evidence.gain_spread = 0.15;
  evidence.spread_sigma = 0.01;
  EXPECT_TRUE(evidence.has_aged());
  evidence.calibrated_spread = 0.2;
  EXPECT_FALSE(evidence.has_aged());
}

TEST(AgeingMonitor, taxels_without_a_force_and_strips_say_nothing) {
  Sheet sheet(1);
  sheet.add(std::vector<double>(kTaxels, std::numeric_limits<double>::quiet_NaN()));
  sheet.add(std::vector<double>(kTaxels, 5.0), TaxelStatus::saturated);
  sheet.add(std::vector<double>(kTaxels));
  EXPECT_EQ(sheet.evidence().comparisons, 0U);
  EXPECT_FALSE(sheet.evidence().gain_spread);
  EXPECT_EQ(describe(sheet.evidence()), "not known yet (0 of 16 squares of taxels compared)");
  AgeingMonitor strip(support::hand_made_model(1, 8));
  ForceFrame force;
  force.newtons.assign(8, 1.0F);
  force.sigma_newtons.assign(8, 0.01F);
  force.taxels.assign(8, TaxelStatus::ok);
  strip.add(force);
  EXPECT_EQ(strip.evidence().comparisons, 0U);
}

TEST(AgeingEvidence, that_tells_of_no_change_does_not_call_it_a_change_of_0_percent) {
  AgeingEvidence evidence;
  evidence.gain_spread = 0.004;
  evidence.spread_sigma = 0.02;
  evidence.comparisons = 214;
  EXPECT_EQ(describe(evidence), "gains have not changed from taxel to taxel (\u00b1 2 %, 214 comparisons)");
  evidence.gain_spread = 0.006;
  EXPECT_EQ(describe(evidence), "gains have changed by about 1 % from taxel to taxel (\u00b1 2 %, 214 comparisons)");
}

}  // namespace
}  // namespace dermis::learn::health
