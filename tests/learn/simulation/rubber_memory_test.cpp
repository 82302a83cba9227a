// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/rubber_memory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace dermis::learn::simulation {
namespace {

constexpr std::uint64_t kSeed = 5;

/// Creep alone.
RubberMemoryOptions only_creep(double creep_per_decade = 0.10) {
  return {.creep_per_decade = creep_per_decade, .loop_gap = 0.0, .touch_gain = 0.0, .release_dip = 0.0};
}

RubberMemoryOptions without_scatter() {
  RubberMemoryOptions options;
  options.touch_gain = 0.0;
  return options;
}

RubberMemory one_taxel(const RubberMemoryOptions& options) {
  return RubberMemory(options, 1, kSeed);
}

void press(RubberMemory& rubber, double load_n, double seconds) {
  rubber.press(std::vector<double>{load_n}, seconds);
}

/// What a load that is held on rested rubber is felt as.
double held(const RubberMemoryOptions& options, double load_n, double seconds) {
  RubberMemory rubber = one_taxel(options);
  press(rubber, load_n, seconds);
  return rubber.material_force(0);
}

TEST(RubberMemory, a_held_load_creeps_by_its_share_per_decade_of_time) {
  for (const double creep : {0.02, 0.10, 0.30}) {
    for (double seconds = 0.005; seconds <= 10.0; seconds *= 1.3) {
      const double growth_n = held(only_creep(creep), 20.0, 10.0 * seconds) - held(only_creep(creep), 20.0, seconds);
      const double decades = std::exp(-seconds / 1000.0) - std::exp(-1000.0 * seconds);
      EXPECT_NEAR(growth_n, 20.0 * creep * decades, 1e-9) << seconds << " s";
      EXPECT_NEAR(growth_n, 20.0 * creep, 0.011 * 20.0 * creep) << seconds << " s";
    }
  }
}

TEST(RubberMemory, creep_has_not_ended_after_a_quarter_of_an_hour) {
  EXPECT_GT(held(only_creep(), 10.0, 1000.0) - held(only_creep(), 10.0, 100.0), 0.9);
}

TEST(RubberMemory, a_load_is_felt_as_it_is_after_a_second) {
  for (const double creep : {0.02, 0.10, 0.30}) {
    EXPECT_NEAR(held(only_creep(creep), 3.0, 1.0), 3.0, 1e-12);
  }
}

TEST(RubberMemory, creep_follows_a_load_that_changes_by_superposition) {
  RubberMemory both = one_taxel(only_creep());
  press(both, 15.0, 15.0);
  press(both, 5.0, 2.0);
  const double expected_n = held(only_creep(), 15.0, 17.0) - held(only_creep(), 10.0, 2.0);
  EXPECT_NEAR(both.material_force(0), expected_n, 1e-9);
}

TEST(RubberMemory, does_not_depend_on_the_time_step) {
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  RubberMemory once = one_taxel(without_scatter());
  RubberMemory often = one_taxel(without_scatter());
  for (int change = 0; change < 200; ++change) {
    const double load_n = random.uniform() < 0.2 ? 0.0 : random.log_uniform(0.1, 50.0);
    const double seconds = random.log_uniform(0.001, 30.0);
    press(once, load_n, seconds);
    double left_s = seconds;
    for (int part = 0; part < 5; ++part) {
      const double step_s = left_s * random.uniform();
      press(often, load_n, step_s);
      left_s -= step_s;
    }
    press(often, load_n, left_s);
    EXPECT_NEAR(once.material_force(0), often.material_force(0), 1e-9);
    EXPECT_NEAR(once.unloaded_share(0), often.unloaded_share(0), 1e-9);
  }
}

/// Relative difference that friction makes at 5 N, on the way up to 50 N and on the way down, `step_s` a step.
std::pair<double, double> friction_of_loop(double step_s) {
  RubberMemoryOptions without = without_scatter();
  without.loop_gap = 0.0;
  RubberMemory rubber = one_taxel(without_scatter());
  RubberMemory frictionless = one_taxel(without);
  std::vector<double> differences;
  for (int step = 1; step <= 200; ++step) {
    const double load_n = step <= 100 ? 0.5 * step : 0.5 * (200 - step);
    press(rubber, load_n, step_s);
    press(frictionless, load_n, step_s);
    if (load_n == 5.0) differences.push_back(rubber.material_force(0) / frictionless.material_force(0) - 1.0);
  }
  return {differences.front(), differences.back()};
}

TEST(RubberMemory, a_loop_is_as_wide_as_asked_however_slow_it_is) {
  for (const double step_s : {0.0, 0.01, 1.0}) {
    const auto [up, down] = friction_of_loop(step_s);
    EXPECT_NEAR(up, -0.04, 1e-9) << step_s << " s";
    EXPECT_NEAR(down, 0.04, 1e-9) << step_s << " s";
  }
}

TEST(RubberMemory, a_loop_turns_around_over_its_three_reaches) {
  RubberMemoryOptions options = without_scatter();
  RubberMemory rubber = one_taxel(options);
  press(rubber, 30.0, 0.0);
  const double up_n = rubber.material_force(0) / 30.0;
  press(rubber, 25.0, 0.0);
  const double change = std::log(31.0 / 26.0);
  const double turned = std::min(2.0, change / 0.1) + change / 0.3 + change / 1.0;
  EXPECT_NEAR(rubber.material_force(0) / 25.0, up_n * (1.0 - 0.08 / 6.0 * (3.0 - turned)) / 0.96, 1e-9);
}

TEST(RubberMemory, a_load_that_falls_is_felt_as_falling) {
  RubberMemoryOptions options = without_scatter();
  options.creep_per_decade = 0.30;
  RubberMemory rubber = one_taxel(options);
  press(rubber, 20.0, 10.0);
  double before_n = rubber.material_force(0);
  for (int step = 1; step <= 380; ++step) {
    press(rubber, 20.0 - 0.05 * step, 0.005);
    EXPECT_LT(rubber.material_force(0), before_n) << "step " << step;
    before_n = rubber.material_force(0);
  }
}

TEST(RubberMemory, a_faint_load_closes_a_part_of_the_contact) {
  EXPECT_NEAR(held(only_creep(), 0.02, 1.0), 0.02 * (1.0 - std::exp(-1.0)), 1e-12);
  EXPECT_NEAR(held(only_creep(), 0.2, 1.0), 0.2, 1e-4 * 0.2);
}

TEST(RubberMemory, a_release_opens_the_contact_at_once_and_lowers_the_unloaded_conductance_for_long) {
  RubberMemory rubber = one_taxel(without_scatter());
  EXPECT_EQ(rubber.unloaded_share(0), 1.0);
  press(rubber, 10.0, 2.0);
  EXPECT_NEAR(rubber.unloaded_share(0), 1.0, 1e-12) << "under a load the path beside it is closed";
  press(rubber, 0.0, 0.0);
  EXPECT_EQ(rubber.material_force(0), 0.0);
  double late_n = 0.0;
  for (const double tau : RubberMemory::kCreepSeconds) late_n += 10.0 * (1.0 - std::exp(-2.0 / tau));
  EXPECT_NEAR(rubber.unloaded_share(0), 1.0 - 0.35 * late_n / (late_n + 0.5), 1e-12);
}

TEST(RubberMemory, the_dip_of_a_release_recovers_over_minutes) {
  RubberMemory rubber = one_taxel(without_scatter());
  press(rubber, 10.0, 2.0);
  press(rubber, 0.0, 0.01);
  double before = rubber.unloaded_share(0);
  for (double seconds = 0.01; seconds < 1000.0; seconds *= 1.5) {
    EXPECT_EQ(rubber.material_force(0), 0.0);
    press(rubber, 0.0, 0.5 * seconds);
    EXPECT_GT(rubber.unloaded_share(0), before);
    before = rubber.unloaded_share(0);
    if (seconds < 7.0) {  // 10 s after the release
      EXPECT_GT(before, 0.6) << seconds << " s";
      EXPECT_LT(before, 0.8) << seconds << " s";
    }
  }
  EXPECT_GT(before, 0.97);
  press(rubber, 0.0, 1e5);
  EXPECT_NEAR(rubber.unloaded_share(0), 1.0, 1e-9);
}

struct Gains {
  double mean = 0.0;
  double sd = 0.0;
};

Gains log_gains(const RubberMemory& rubber, std::size_t taxels, double material_n) {
  Gains gains;
  for (std::size_t i = 0; i < taxels; ++i) {
    gains.mean += std::log(rubber.material_force(i) / material_n) / static_cast<double>(taxels);
  }
  double variance = 0.0;
  for (std::size_t i = 0; i < taxels; ++i) {
    const double away = std::log(rubber.material_force(i) / material_n) - gains.mean;
    variance += away * away / static_cast<double>(taxels);
  }
  gains.sd = std::sqrt(variance);
  return gains;
}

TEST(RubberMemory, gains_scatter_from_touch_to_touch_as_asked) {
  constexpr std::size_t kTaxels = 4096;
  RubberMemoryOptions options = only_creep();
  options.touch_gain = 0.05;
  RubberMemory rubber(options, kTaxels, kSeed);
  rubber.press(std::vector<double>(kTaxels, 10.0), 1.0);
  const Gains gains = log_gains(rubber, kTaxels, 10.0);
  EXPECT_NEAR(gains.mean, 0.0, 5.0 * 0.05 / 64.0);
  EXPECT_NEAR(gains.sd, 0.05, 5.0 * 0.05 / 64.0 / std::sqrt(2.0));
}

TEST(RubberMemory, a_gain_lasts_from_onset_to_release) {
  RubberMemoryOptions options = only_creep();
  options.touch_gain = 0.05;
  RubberMemory rubber = one_taxel(options);
  press(rubber, 10.0, 1.0);
  const double first = rubber.material_force(0) / 10.0;
  EXPECT_NE(first, 1.0);
  press(rubber, 0.5, 0.0);
  press(rubber, 10.0, 0.0);
  EXPECT_NEAR(rubber.material_force(0) / 10.0, first, 1e-12);
  press(rubber, 0.0, 1e6);
  press(rubber, 10.0, 1.0);
  EXPECT_GT(std::abs(rubber.material_force(0) / 10.0 / first - 1.0), 1e-4);
}

TEST(RubberMemory, gains_follow_the_seed) {
  RubberMemoryOptions options = only_creep();
  options.touch_gain = 0.05;
  const auto material_n = [&](std::uint64_t seed) {
    RubberMemory rubber(options, 1, seed);
    press(rubber, 10.0, 1.0);
    return rubber.material_force(0);
  };
  EXPECT_EQ(material_n(1), material_n(1));
  EXPECT_NE(material_n(1), material_n(2));
}

TEST(RubberMemory, options_out_of_range_are_named) {
  const auto refusal = [](const RubberMemoryOptions& options) { return options.validate().error().message; };
  EXPECT_TRUE(RubberMemoryOptions{}.validate());
  EXPECT_EQ(refusal({.creep_per_decade = 0.01}).find("rubber.creep_per_decade: must be 0.02 to 0.3"), 0U);
  EXPECT_EQ(refusal({.creep_per_decade = 0.31}).find("rubber.creep_per_decade:"), 0U);
  EXPECT_EQ(refusal({.loop_gap = -0.1}).find("rubber.loop_gap:"), 0U);
  EXPECT_EQ(refusal({.touch_gain = std::numeric_limits<double>::quiet_NaN()}).find("rubber.touch_gain:"), 0U);
  EXPECT_EQ(refusal({.release_dip = 0.7}).find("rubber.release_dip:"), 0U);
}

}  // namespace
}  // namespace dermis::learn::simulation
