// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/rubber.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

namespace dermis::learn::simulation {
namespace {

constexpr std::uint64_t kNoiseSeed = 7;

RubberOptions ideal_rubber() {
  RubberOptions options;
  options.resistance_spread = 0.0;
  options.exponent_spread = 0.0;
  options.temperature_coefficient_spread = 0.0;
  options.pink_noise = 0.0;
  return options;
}

ConductiveRubber make_rubber(const RubberOptions& options, std::size_t rows = 1, std::size_t cols = 1) {
  return ConductiveRubber::create(options, rows, cols, kNoiseSeed).value();
}

/// What a perfect calibration says of one taxel at 20 C.
double material_force(ConductiveRubber& rubber, std::size_t taxel = 0) {
  std::vector<double> siemens(rubber.taxel_count());
  rubber.read(20.0, siemens);
  return rubber.force_from_conductance(taxel, siemens[taxel], 20.0);
}

void press_one(ConductiveRubber& rubber, double force_n, double seconds) {
  rubber.press(std::vector<double>{force_n}, seconds);
}

struct Moments {
  double mean;
  double sd;
};

Moments moments(const std::vector<double>& values) {
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double variance = 0.0;
  for (const double value : values) variance += (value - mean) * (value - mean) / static_cast<double>(values.size());
  return {mean, std::sqrt(variance)};
}

TEST(Rubber, has_its_resistance_at_ten_newtons) {
  const ConductiveRubber rubber = make_rubber(ideal_rubber());
  EXPECT_NEAR(rubber.conductance_from_force(0, 10.0, 20.0), 1.0 / 900.0 + 1.0 / 200e3, 1e-15);
  EXPECT_NEAR(rubber.conductance_from_force(0, 50.0, 20.0), std::pow(5.0, 0.9) / 900.0 + 1.0 / 200e3, 1e-15);
  EXPECT_DOUBLE_EQ(rubber.conductance_from_force(0, 0.0, 20.0), 1.0 / 200e3);
}

TEST(Rubber, contact_resistance_is_part_of_the_resistance_at_ten_newtons) {
  RubberOptions options = ideal_rubber();
  options.contact_ohm = 300.0;
  const ConductiveRubber rubber = make_rubber(options);
  EXPECT_NEAR(rubber.conductance_from_force(0, 10.0, 20.0), 1.0 / 900.0 + 1.0 / 200e3, 1e-15);
  EXPECT_NEAR(rubber.conductance_from_force(0, 1e9, 20.0), 1.0 / 300.0 + 1.0 / 200e3, 1e-9);
}

TEST(Rubber, temperature_scales_the_resistance) {
  RubberOptions options = ideal_rubber();
  options.temperature_curvature = 2e-5;
  const ConductiveRubber rubber = make_rubber(options);
  const double cold = rubber.conductance_from_force(0, 3.0, 20.0);
  EXPECT_NEAR(rubber.conductance_from_force(0, 3.0, 50.0) / cold, std::exp(0.004 * 30.0 - 2e-5 * 900.0), 1e-12);
}

TEST(Rubber, inverse_law_returns_the_force) {
  RubberOptions options;
  options.contact_ohm = 150.0;
  options.temperature_curvature = 1e-5;
  const ConductiveRubber rubber = make_rubber(options, 8, 8);
  constexpr std::uint64_t kSeed = 3;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  for (std::size_t taxel = 0; taxel < rubber.taxel_count(); ++taxel) {
    const double force_n = random.log_uniform(0.01, 100.0);
    const double celsius = random.uniform(-20.0, 80.0);
    const double siemens = rubber.conductance_from_force(taxel, force_n, celsius);
    EXPECT_NEAR(rubber.force_from_conductance(taxel, siemens, celsius) / force_n, 1.0, 1e-9);
  }
}

TEST(Rubber, inverse_law_is_zero_when_unloaded_and_infinite_beyond_the_contact) {
  RubberOptions options = ideal_rubber();
  options.contact_ohm = 100.0;
  const ConductiveRubber rubber = make_rubber(options);
  EXPECT_EQ(rubber.force_from_conductance(0, 0.9 / 200e3, 20.0), 0.0);
  EXPECT_EQ(rubber.force_from_conductance(0, 1.0 / 99.0, 20.0), std::numeric_limits<double>::infinity());
}

TEST(Rubber, taxels_scatter_as_asked) {
  RubberOptions options;
  options.unloaded_ohm = 1e12;
  const ConductiveRubber rubber = make_rubber(options, 64, 64);
  std::vector<double> log_ohm;
  std::vector<double> exponent;
  std::vector<double> coefficient;
  for (std::size_t i = 0; i < rubber.taxel_count(); ++i) {
    const double at_10n = rubber.conductance_from_force(i, 10.0, 20.0);
    log_ohm.push_back(-std::log(at_10n));
    exponent.push_back(std::log10(at_10n / rubber.conductance_from_force(i, 1.0, 20.0)));
    coefficient.push_back(-std::log(rubber.conductance_from_force(i, 10.0, 30.0) / at_10n) / 10.0);
  }
  constexpr double kSdOfMean = 5.0 / 64.0;  // Five standard errors of 4096 values, in units of the sd.
  constexpr double kSdOfSd = kSdOfMean / 1.414;
  EXPECT_NEAR(moments(log_ohm).mean, std::log(900.0), 0.15 * kSdOfMean);
  EXPECT_NEAR(moments(log_ohm).sd, 0.15, 0.15 * kSdOfSd);
  EXPECT_NEAR(moments(exponent).mean, 0.9, 0.045 * kSdOfMean);
  EXPECT_NEAR(moments(exponent).sd, 0.045, 0.045 * kSdOfSd);
  EXPECT_NEAR(moments(coefficient).mean, -0.004, 0.0008 * kSdOfMean);
  EXPECT_NEAR(moments(coefficient).sd, 0.0008, 0.0008 * kSdOfSd);
}

TEST(Rubber, seed_of_the_piece_alone_fixes_its_taxels) {
  const RubberOptions options;
  const auto one = ConductiveRubber::create(options, 4, 4, 1).value();
  const auto same = ConductiveRubber::create(options, 4, 4, 2).value();
  RubberOptions other_options;
  other_options.seed = 2;
  const auto other = ConductiveRubber::create(other_options, 4, 4, 1).value();
  for (std::size_t i = 0; i < one.taxel_count(); ++i) {
    const double siemens = one.conductance_from_force(i, 5.0, 35.0);
    EXPECT_EQ(siemens, same.conductance_from_force(i, 5.0, 35.0));
    EXPECT_NE(siemens, other.conductance_from_force(i, 5.0, 35.0));
  }
}

TEST(Rubber, hysteresis_loop_is_as_wide_as_asked) {
  RubberOptions options = ideal_rubber();
  options.hysteresis = 0.1;
  ConductiveRubber rubber = make_rubber(options);
  for (const double force_n : {1.0, 4.0, 7.0, 10.0}) press_one(rubber, force_n, 0.1);
  EXPECT_NEAR(material_force(rubber), 9.5, 1e-9);
  for (const double force_n : {25.0, 50.0, 40.0, 22.0, 10.0}) press_one(rubber, force_n, 0.1);
  EXPECT_NEAR(material_force(rubber), 10.5, 1e-9);
}

TEST(Rubber, hysteresis_turns_around_over_its_reach) {
  RubberOptions options = ideal_rubber();
  options.hysteresis = 0.2;
  ConductiveRubber rubber = make_rubber(options);
  press_one(rubber, 30.0, 0.1);
  press_one(rubber, 25.0, 0.1);
  const double loop = 1.0 - std::log(31.0 / 26.0) / ConductiveRubber::kHysteresisReach;
  EXPECT_NEAR(material_force(rubber), 25.0 * (1.0 - 0.1 * loop), 1e-9);
}

TEST(Rubber, hysteresis_depends_on_forces_not_on_time) {
  RubberOptions options = ideal_rubber();
  options.hysteresis = 0.2;
  ConductiveRubber slow = make_rubber(options);
  ConductiveRubber fast = make_rubber(options);
  for (const double force_n : {5.0, 20.0, 12.0, 15.0}) {
    press_one(slow, force_n, 100.0);
    press_one(fast, force_n, 0.001);
  }
  EXPECT_DOUBLE_EQ(material_force(slow), material_force(fast));
}

TEST(Rubber, creep_follows_its_three_time_constants) {
  RubberOptions options = ideal_rubber();
  options.creep = 0.06;
  for (const double seconds : {0.0, 0.1, 1.0, 3.0, 30.0, 300.0, 1e5}) {
    ConductiveRubber rubber = make_rubber(options);
    press_one(rubber, 20.0, seconds);
    double late = 0.0;
    for (const double tau : {0.1, 3.0, 100.0}) late += (1.0 - std::exp(-seconds / tau)) / 3.0;
    EXPECT_NEAR(material_force(rubber), 20.0 * (0.94 + 0.06 * late), 1e-9) << seconds << " s";
  }
}

TEST(Rubber, creep_does_not_depend_on_the_time_step) {
  RubberOptions options = ideal_rubber();
  options.creep = 0.1;
  ConductiveRubber once = make_rubber(options);
  ConductiveRubber often = make_rubber(options);
  press_one(once, 8.0, 5.0);
  for (int step = 0; step < 50; ++step) press_one(often, 8.0, 0.1);
  EXPECT_NEAR(material_force(once), material_force(often), 1e-9);
}

TEST(Rubber, creep_recovers_after_unloading) {
  RubberOptions options = ideal_rubber();
  options.creep = 0.06;
  ConductiveRubber rubber = make_rubber(options);
  press_one(rubber, 20.0, 1e6);
  press_one(rubber, 0.0, 0.0);
  EXPECT_NEAR(material_force(rubber), 20.0 * 0.06, 1e-9);
  press_one(rubber, 0.0, 1e5);
  EXPECT_NEAR(material_force(rubber), 0.0, 1e-6);
}

/// Relative noise of unloaded taxels, [samples][taxels].
std::vector<std::vector<double>> record_noise(double k, std::size_t samples, double step_s, std::size_t side) {
  RubberOptions options = ideal_rubber();
  options.pink_noise = k;
  ConductiveRubber rubber = make_rubber(options, side, side);
  const std::vector<double> unloaded(side * side);
  std::vector<std::vector<double>> record(samples, std::vector<double>(side * side));
  for (std::vector<double>& sample : record) {
    rubber.press(unloaded, step_s);
    rubber.read(20.0, sample);
    for (double& value : sample) value = value * options.unloaded_ohm - 1.0;
  }
  return record;
}

/// Closed form: every decade has the variance K ln 10 and decays with its corner frequency.
double noise_covariance(double k, double lag_s) {
  double sum = 0.0;
  for (const double corner_hz : ConductiveRubber::kNoiseCornersHz) {
    sum += k * std::numbers::ln10 * std::exp(-2.0 * std::numbers::pi * corner_hz * lag_s);
  }
  return sum;
}

TEST(Rubber, noise_has_the_covariance_of_its_processes_at_any_time_step) {
  constexpr double kK = 1e-6;
  constexpr std::size_t kSide = 128;
  for (const double step_s : {0.003, 0.1, 5.0, 400.0}) {
    const auto record = record_noise(kK, 3, step_s, kSide);
    double variance = 0.0;
    double covariance = 0.0;
    for (std::size_t i = 0; i < kSide * kSide; ++i) {
      variance += record[2][i] * record[2][i] / (kSide * kSide);
      covariance += record[0][i] * record[2][i] / (kSide * kSide);
    }
    const double expected = noise_covariance(kK, 0.0);
    EXPECT_NEAR(variance, expected, 5.0 * std::sqrt(2.0) / kSide * expected) << step_s << " s";
    EXPECT_NEAR(covariance, noise_covariance(kK, 2.0 * step_s), 5.0 * std::sqrt(2.0) / kSide * expected)
        << step_s << " s";
  }
}

TEST(Rubber, noise_has_the_density_k_over_f) {
  constexpr double kK = 1e-6;
  constexpr std::size_t kSide = 24;
  constexpr std::size_t kSamples = 2048;
  constexpr double kStepS = 0.01;
  const auto record = record_noise(kK, kSamples, kStepS, kSide);
  for (const double hertz : {0.5, 1.0, 2.0, 4.0, 8.0}) {
    double measured = 0.0;  // Mean one-sided periodogram.
    for (std::size_t taxel = 0; taxel < kSide * kSide; ++taxel) {
      std::complex<double> sum = 0.0;
      for (std::size_t n = 0; n < kSamples; ++n) {
        sum += record[n][taxel] * std::polar(1.0, -2.0 * std::numbers::pi * hertz * kStepS * static_cast<double>(n));
      }
      measured += 2.0 * kStepS / kSamples * std::norm(sum) / (kSide * kSide);
    }
    double expected = noise_covariance(kK, 0.0);  // Of the periodogram, window included.
    for (std::size_t lag = 1; lag < kSamples; ++lag) {
      const double lag_s = kStepS * static_cast<double>(lag);
      const double window = 1.0 - static_cast<double>(lag) / kSamples;
      expected += 2.0 * window * noise_covariance(kK, lag_s) * std::cos(2.0 * std::numbers::pi * hertz * lag_s);
    }
    expected *= 2.0 * kStepS;
    EXPECT_NEAR(measured / expected, 1.0, 5.0 / kSide) << hertz << " Hz";
    EXPECT_NEAR(measured / (kK / hertz), 1.0, 0.35) << hertz << " Hz";
  }
}

RubberOptions remembering_rubber() {
  RubberOptions options = ideal_rubber();
  options.memory.emplace().touch_gain = 0.0;
  return options;
}

TEST(Rubber, with_memory_a_load_is_felt_as_rubber_memory_says) {
  ConductiveRubber rubber = make_rubber(remembering_rubber());
  RubberMemory memory(*remembering_rubber().memory, 1, 1);
  for (const double force_n : {5.0, 15.0, 2.0}) {
    press_one(rubber, force_n, 3.0);
    memory.press(std::vector<double>{force_n}, 3.0);
    EXPECT_NEAR(material_force(rubber), memory.material_force(0), 1e-9);
  }
}

TEST(Rubber, with_memory_the_reading_after_a_release_is_below_the_earlier_one_and_comes_back) {
  ConductiveRubber rubber = make_rubber(remembering_rubber());
  const auto siemens_after = [&](double force_n, double seconds) {
    press_one(rubber, force_n, seconds);
    std::vector<double> siemens(1);
    rubber.read(20.0, siemens);
    return siemens[0];
  };
  const double rested = siemens_after(0.0, 1.0);
  EXPECT_EQ(rested, 1.0 / 200e3);
  EXPECT_GT(siemens_after(10.0, 2.0), 100.0 * rested);
  const double released = siemens_after(0.0, 0.1) / rested;
  EXPECT_GT(released, 0.6);
  EXPECT_LT(released, 0.7);
  const double recovering = siemens_after(0.0, 10.0) / rested;
  EXPECT_GT(recovering, released);
  EXPECT_LT(recovering, 0.8);
  EXPECT_NEAR(siemens_after(0.0, 1e5) / rested, 1.0, 1e-9);
}

TEST(Rubber, gains_of_touches_do_not_depend_on_the_noise) {
  RubberOptions quiet = ideal_rubber();
  quiet.memory.emplace();
  RubberOptions noisy = quiet;
  noisy.pink_noise = 1e-12;
  ConductiveRubber one = make_rubber(quiet);
  ConductiveRubber other = make_rubber(noisy);
  for (int touch = 0; touch < 5; ++touch) {
    press_one(one, 10.0, 1.0);
    press_one(other, 10.0, 1.0);
    EXPECT_NEAR(material_force(one) / material_force(other), 1.0, 1e-4);
    press_one(one, 0.0, 1.0);
    press_one(other, 0.0, 1.0);
  }
}

TEST(Rubber, memory_is_chosen_by_its_name) {
  RubberOptions options;
  ASSERT_TRUE(choose_memory("rubber", options));
  ASSERT_TRUE(options.memory);
  options.memory->touch_gain = 0.1;
  ASSERT_TRUE(choose_memory("rubber", options));
  EXPECT_EQ(options.memory->touch_gain, 0.1);
  ASSERT_TRUE(choose_memory("simple", options));
  EXPECT_FALSE(options.memory);
  EXPECT_EQ(choose_memory("elephant", options).error().message, "memory: must be simple or rubber, not 'elephant'");
}

TEST(Rubber, neighbours_share_a_load_whose_sum_is_kept_inside) {
  RubberOptions options = ideal_rubber();
  options.mechanical_spread = 0.08;
  ConductiveRubber rubber = make_rubber(options, 3, 3);
  rubber.press(std::vector<double>{0, 0, 0, 0, 10, 0, 0, 0, 0}, 1.0);
  EXPECT_NEAR(material_force(rubber, 4), 9.2, 1e-9);
  double sum = 0.0;
  for (std::size_t i = 0; i < 9; ++i) sum += material_force(rubber, i);
  EXPECT_NEAR(sum, 10.0, 1e-9);
  for (const std::size_t neighbour : {1U, 3U, 5U, 7U}) EXPECT_NEAR(material_force(rubber, neighbour), 0.2, 1e-9);
  EXPECT_EQ(material_force(rubber, 0), 0.0);
}

TEST(Rubber, shares_that_fall_off_the_edge_are_lost) {
  RubberOptions options = ideal_rubber();
  options.mechanical_spread = 0.08;
  ConductiveRubber rubber = make_rubber(options, 2, 2);
  rubber.press(std::vector<double>{10, 0, 0, 0}, 1.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) sum += material_force(rubber, i);
  EXPECT_NEAR(sum, 9.6, 1e-9);
}

TEST(Rubber, an_aged_taxel_feels_its_gain_times_the_force) {
  RubberOptions options;
  const ConductiveRubber fresh = make_rubber(options, 4, 4);
  options.gain = 1.1;
  const ConductiveRubber aged = make_rubber(options, 4, 4);
  for (std::size_t taxel = 0; taxel < 16; ++taxel) {
    EXPECT_NEAR(fresh.force_from_conductance(taxel, aged.conductance_from_force(taxel, 5.0, 20.0), 20.0), 5.5, 1e-9);
    EXPECT_EQ(aged.conductance_from_force(taxel, 0.0, 20.0), fresh.conductance_from_force(taxel, 0.0, 20.0));
  }
}

TEST(Rubber, gains_of_aged_taxels_scatter_as_asked) {
  RubberOptions options;
  const ConductiveRubber fresh = make_rubber(options, 64, 64);
  options.gain_spread = 0.1;
  const ConductiveRubber aged = make_rubber(options, 64, 64);
  std::vector<double> log_gain;
  for (std::size_t taxel = 0; taxel < aged.taxel_count(); ++taxel) {
    const double siemens = aged.conductance_from_force(taxel, 5.0, 20.0);
    log_gain.push_back(std::log(fresh.force_from_conductance(taxel, siemens, 20.0) / 5.0));
  }
  EXPECT_NEAR(moments(log_gain).mean, 0.0, 0.1 * 5.0 / 64.0);
  EXPECT_NEAR(moments(log_gain).sd, 0.1, 0.1 * 5.0 / 64.0 / 1.414);
}

TEST(Rubber, grades_rank_by_carbon_content) {
  EXPECT_EQ(rubber_grade(10)->resistance_at_10n_ohm, RubberOptions{}.resistance_at_10n_ohm);
  EXPECT_NEAR(rubber_grade(5)->resistance_at_10n_ohm, 900.0 * 12.25, 1e-9);
  EXPECT_NEAR(rubber_grade(15)->resistance_at_10n_ohm, 900.0 * 49.0 / 144.0, 1e-9);
  for (const int percent : {5, 10, 15}) EXPECT_TRUE(rubber_grade(percent)->validate()) << percent;
  EXPECT_EQ(rubber_grade(12).error().kind, ErrorKind::bad_input);
}

TEST(Rubber, options_out_of_range_are_named) {
  EXPECT_TRUE(RubberOptions{}.validate());
  RubberOptions options;
  options.exponent = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(options.validate().error().message.find("rubber.exponent:"), 0U);
  options = {};
  options.creep = -0.1;
  EXPECT_EQ(options.validate().error().message.find("rubber.creep:"), 0U);
  options = {};
  options.gain = 0.0;
  EXPECT_EQ(options.validate().error().message.find("rubber.gain:"), 0U);
  options = {};
  options.contact_ohm = 900.0;
  EXPECT_EQ(ConductiveRubber::create(options, 2, 2, 1).error().message.find("rubber.contact_ohm:"), 0U);
  options = {};
  options.memory.emplace().touch_gain = 1.0;
  EXPECT_EQ(options.validate().error().message.find("rubber.touch_gain:"), 0U);
  options.memory->touch_gain = 0.0;
  options.creep = 0.05;
  EXPECT_EQ(options.validate().error().message.find("rubber.hysteresis, rubber.creep:"), 0U);
}

TEST(Rubber, scatter_that_leaves_a_taxel_below_the_contact_is_an_error) {
  RubberOptions options;
  options.contact_ohm = 890.0;
  const auto rubber = ConductiveRubber::create(options, 8, 8, 1);
  ASSERT_FALSE(rubber);
  EXPECT_EQ(rubber.error().message.find("rubber.contact_ohm: leaves taxel r"), 0U);
}

}  // namespace
}  // namespace dermis::learn::simulation
