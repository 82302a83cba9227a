// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/fusion/force_fusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/random_networks.hpp"

namespace dermis::touch::fusion {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

ConductanceFrame make_frame(std::vector<double> siemens, std::optional<double> temperature_celsius = 25.0) {
  ConductanceFrame frame;
  frame.taxels.assign(siemens.size(), TaxelStatus::ok);
  frame.sigma_siemens.assign(siemens.size(), 1e-6);
  frame.siemens = std::move(siemens);
  frame.temperature_celsius = temperature_celsius;
  return frame;
}

ForceFrame fuse(const ForceNetworks& networks, const ConductanceFrame& conductance) {
  ForceFusion fusion(networks);
  ForceFrame force;
  fusion.process(conductance, force);
  return force;
}

/// One taxel, a plain power law: F = 10 N (e / 1 mS)^0.9, calibrated to 4 mS.
ForceNetworks power_law() {
  ForceNetworks networks;
  networks.shape = {2, 0, 2};
  networks.unloaded.temperature.centre_celsius = 20.0;
  networks.unloaded.temperature.half_span_celsius = 10.0;
  networks.unloaded.offset_siemens = {1e-5};
  networks.unloaded.per_celsius = {1e-6};
  networks.reference_siemens = {1e-3F};
  networks.heaviest_siemens = {4e-3F};
  networks.heaviest_newtons = {std::numeric_limits<float>::infinity()};
  networks.gain = {1.0F};
  networks.dead = {0};
  networks.offset_sigma_siemens = {0.0F};
  networks.relative_sigma.assign(kSigmaKnots, 0.01F);
  networks.parameters = {std::log(10.0F), 0.9F, 0.0F};  // c, s_0, s_1
  return networks;
}

/// So many taxels of it.
ForceNetworks equal_power_laws(std::size_t taxels) {
  ForceNetworks networks = power_law();
  const auto repeat = [&](auto& values) { values.assign(taxels, values.front()); };
  repeat(networks.unloaded.offset_siemens);
  repeat(networks.unloaded.per_celsius);
  repeat(networks.reference_siemens);
  repeat(networks.heaviest_siemens);
  repeat(networks.heaviest_newtons);
  repeat(networks.gain);
  repeat(networks.dead);
  repeat(networks.offset_sigma_siemens);
  networks.relative_sigma.assign(kSigmaKnots * taxels, 0.01F);
  std::vector<float> parameters;
  for (const float value : networks.parameters) parameters.insert(parameters.end(), taxels, value);
  networks.parameters = std::move(parameters);
  return networks;
}

TEST(ForceFusion, power_law_is_the_one_computed_by_hand) {
  for (const double excess : {1e-5, 1e-4, 1e-3, 3e-3}) {
    const auto force = fuse(power_law(), make_frame({1e-5 + excess}, 20.0));
    EXPECT_NEAR(force.newtons[0] / (10.0 * std::pow(excess / 1e-3, 0.9)), 1.0, 1e-5) << excess;
    EXPECT_EQ(force.status, FrameStatus::ok);
    EXPECT_EQ(force.taxels[0], TaxelStatus::ok);
  }
}

TEST(ForceFusion, force_is_the_documented_formula) {
  for (const std::size_t inputs : {2U, 3U}) {
    for (const std::size_t hidden : {0U, 1U, 4U}) {
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(testing::Message() << inputs << "-" << hidden << "-1, seed " << seed);
        Random random(seed);
        const auto networks = support::random_networks(37, inputs, hidden, seed);
        const double offset = random.uniform(-20.0, 20.0);
        std::vector<double> siemens(37);
        for (std::size_t k = 0; k < 37; ++k) {
          siemens[k] = networks.unloaded.offset_siemens[k] + random.log_uniform(1e-5, 2e-3);
        }
        const auto force = fuse(networks, make_frame(siemens, 25.0 + offset));
        for (std::size_t k = 0; k < 37; ++k) {
          if (force.taxels[k] == TaxelStatus::above_range) continue;  // has tests of its own
          const double expected = support::reference_newtons(networks, k, siemens[k], offset);
          EXPECT_NEAR(force.newtons[k] / expected, 1.0, 3e-5) << "taxel " << k;
        }
      }
    }
  }
}

TEST(ForceFusion, force_rises_with_conductance_throughout) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    constexpr std::size_t kTaxels = 9;
    const auto networks = support::random_networks(kTaxels, 3, 3, seed);
    ForceFusion fusion(networks);
    ForceFrame force;
    std::vector<float> last(kTaxels, 0.0F);
    std::vector<float> first_pressed(kTaxels, 0.0F);
    for (int step = 0; step <= 4000; ++step) {
      std::vector<double> siemens(kTaxels);
      for (std::size_t k = 0; k < kTaxels; ++k) {
        // From below the unloaded conductance to beyond the heaviest load, denser towards small loads.
        const auto heaviest = static_cast<double>(networks.heaviest_siemens[k]);
        siemens[k] = networks.unloaded.offset_siemens[k] + 1.3 * heaviest * std::pow(step / 4000.0, 3) - 1e-6;
      }
      fusion.process(make_frame(siemens, 31.0), force);
      for (std::size_t k = 0; k < kTaxels; ++k) {
        // Rounding of single precision alone may lower a force that hardly changes.
        ASSERT_GE(force.newtons[k], last[k] * (1.0F - 2e-6F)) << "taxel " << k << ", step " << step;
        last[k] = std::max(last[k], force.newtons[k]);
        if (first_pressed[k] == 0.0F) first_pressed[k] = force.newtons[k];
      }
    }
    for (std::size_t k = 0; k < kTaxels; ++k) EXPECT_GT(last[k], 2.0F * first_pressed[k]) << "taxel " << k;
  }
}

TEST(ForceFusion, force_is_zero_at_and_below_the_unloaded_conductance) {
  const auto networks = support::random_networks(5, 3, 2, 1);
  std::vector<double> siemens = networks.unloaded.offset_siemens;
  siemens[1] -= 1e-9;
  siemens[2] -= 1e-3;
  siemens[3] = 0.0;
  siemens[4] = -1.0;
  const auto force = fuse(networks, make_frame(siemens));
  for (const float newtons : force.newtons) EXPECT_EQ(newtons, 0.0F);
  EXPECT_EQ(force.status, FrameStatus::ok);
  EXPECT_EQ(force.taxels, std::vector<TaxelStatus>(5, TaxelStatus::ok));
}

TEST(ForceFusion, force_leaves_zero_without_a_jump) {
  // 10 N (1e-6)^0.9 = 40 uN is the least that the first sliver of conductance can give.
  float last = 0.0F;
  for (double excess = 1e-16; excess < 1e-6; excess *= 1.5) {
    const float newtons = fuse(power_law(), make_frame({1e-5 + excess}, 20.0)).newtons[0];
    EXPECT_GE(newtons, last) << excess;
    EXPECT_LE(newtons, 1.001 * 10.0 * std::pow(std::max(excess / 1e-3, 1e-6), 0.9)) << excess;
    last = newtons;
  }
}

TEST(ForceFusion, unloaded_conductance_follows_the_temperature) {
  // At 25 C the offset is 1e-5 + 5 * 1e-6 S.
  const auto networks = power_law();
  EXPECT_EQ(fuse(networks, make_frame({1.5e-5}, 25.0)).newtons[0], 0.0F);
  EXPECT_NEAR(fuse(networks, make_frame({1e-3 + 1.5e-5}, 25.0)).newtons[0], 10.0, 1e-4);
  EXPECT_GT(fuse(networks, make_frame({1.5e-5}, 20.0)).newtons[0], 0.0F);
}

TEST(ForceFusion, gain_scales_the_force) {
  auto networks = power_law();
  networks.gain = {2.5F};
  EXPECT_NEAR(fuse(networks, make_frame({1e-3 + 1e-5}, 20.0)).newtons[0], 25.0, 2.5e-4);
}

/// What is believed of x = ln(force / heaviest) where the end has a relative error of 1 %.
double believed(double x) {
  return x * x * x / (x * x + 0.01 * 0.01);
}

/// What sigma has beside that of the end, x = ln(force / heaviest).
double unlearned(double x) {
  return x * std::hypot(0.2, 0.3 * x);
}

TEST(ForceFusion, above_the_heaviest_load_the_law_goes_on_and_is_flagged_and_less_sure) {
  const double at_end = 10.0 * std::pow(4.0, 0.9);
  for (const double excess : {4.001e-3, 8e-3, 2e-2}) {
    const auto force = fuse(power_law(), make_frame({1e-5 + excess}, 20.0));
    const double expected = at_end * std::exp(believed(0.9 * std::log(excess / 4e-3)));
    EXPECT_NEAR(force.newtons[0] / expected, 1.0, 1e-4);
    EXPECT_EQ(force.taxels[0], TaxelStatus::above_range);
    EXPECT_EQ(force.status, FrameStatus::above_range);
    EXPECT_NEAR(force.sigma_newtons[0] / expected, std::hypot(0.01, unlearned(std::log(expected / at_end))), 3e-4);
    EXPECT_TRUE(std::isfinite(force.signal_to_noise[0]));
  }
  EXPECT_EQ(fuse(power_law(), make_frame({1e-5 + 3.999e-3}, 20.0)).status, FrameStatus::ok);
}

TEST(ForceFusion, neither_force_nor_sigma_jumps_at_the_heaviest_load) {
  const auto below = fuse(power_law(), make_frame({1e-5 + 3.99999e-3}, 20.0));
  const auto above = fuse(power_law(), make_frame({1e-5 + 4.00001e-3}, 20.0));
  EXPECT_NEAR(above.newtons[0] / below.newtons[0], 1.0, 1e-4);
  EXPECT_NEAR(above.sigma_newtons[0] / below.sigma_newtons[0], 1.0, 1e-3);
}

TEST(ForceFusion, far_above_the_heaviest_load_only_that_it_is_more_is_known) {
  const double at_end = 10.0 * std::pow(4.0, 0.9);
  for (const double excess : {0.1, 1.0, 1e6}) {
    const auto force = fuse(power_law(), make_frame({1e-5 + excess}, 20.0));
    EXPECT_NEAR(force.newtons[0] / (8.0 * at_end), 1.0, 1e-5);
    EXPECT_EQ(force.sigma_newtons[0], std::numeric_limits<float>::infinity());
    EXPECT_EQ(force.taxels[0], TaxelStatus::above_range);
  }
}

TEST(ForceFusion, beyond_is_what_is_more_than_the_heaviest_calibrated_load) {
  auto networks = power_law();
  networks.heaviest_newtons = {20.0F};
  const auto inside = fuse(networks, make_frame({1e-3 + 1e-5}, 20.0));
  EXPECT_NEAR(inside.newtons[0], 10.0, 1e-4);
  EXPECT_EQ(inside.taxels[0], TaxelStatus::ok);
  for (const double excess : {3e-3, 5e-3}) {  // before the heaviest conductance, and beyond it
    const auto above = fuse(networks, make_frame({1e-5 + excess}, 20.0));
    const double expected = 20.0 * std::exp(believed(std::log(0.5 * std::pow(excess / 1e-3, 0.9))));
    EXPECT_NEAR(above.newtons[0] / expected, 1.0, 1e-4);
    EXPECT_NEAR(above.sigma_newtons[0] / expected, std::hypot(0.01, unlearned(std::log(expected / 20.0))), 3e-4);
    EXPECT_EQ(above.taxels[0], TaxelStatus::above_range);
    EXPECT_EQ(above.status, FrameStatus::above_range);
  }
}

TEST(ForceFusion, beyond_a_table_is_what_its_heavier_half_says_and_not_its_last_two_knots) {
  auto networks = power_law();
  networks.tables = {{0}, 4, {1e-3F, 2e-3F, 3.9e-3F, 4.01e-3F}, {10.0F, 20.0F, 39.0F, 41.2F}, {0.0F}};
  const double at_end = 41.0;
  const double exponent = std::log(41.2 / 20.0) / std::log(4.01 / 2.0);
  const auto force = fuse(networks, make_frame({1e-5 + 6e-3}, 20.0));
  EXPECT_NEAR(force.newtons[0] / (at_end * std::exp(believed(exponent * std::log(6.0 / 4.0)))), 1.0, 1e-3);
  EXPECT_EQ(force.taxels[0], TaxelStatus::above_range);
}

TEST(ForceFusion, saturated_taxel_stays_saturated_and_keeps_a_force) {
  auto frame = make_frame({1e-5 + 1e-2}, 20.0);
  frame.taxels[0] = TaxelStatus::saturated;
  frame.status = FrameStatus::saturated;
  const auto force = fuse(power_law(), frame);
  EXPECT_EQ(force.taxels[0], TaxelStatus::saturated);
  EXPECT_EQ(force.status, FrameStatus::saturated | FrameStatus::above_range);
  EXPECT_GT(force.newtons[0], 30.0F);
}

TEST(ForceFusion, saturated_taxel_has_at_least_the_force_given) {
  auto networks = power_law();
  networks.heaviest_newtons = {20.0F};
  auto frame = make_frame({1e-5 + 1e-2}, 20.0);
  frame.taxels[0] = TaxelStatus::saturated;
  const auto force = fuse(networks, frame);
  EXPECT_EQ(force.newtons[0], 20.0F);
  EXPECT_EQ(force.sigma_newtons[0], std::numeric_limits<float>::infinity());
  EXPECT_EQ(force.signal_to_noise[0], std::numeric_limits<float>::infinity());
}

TEST(ForceFusion, table_takes_the_place_of_the_network_and_of_its_gain) {
  auto networks = support::random_networks(5, 3, 2, 11);  // 5 ... 45 C
  networks.gain[3] = 2.0F;
  networks.unloaded.per_celsius.assign(5, 0.0);
  networks.temperature_sigma_celsius = 0.0;
  networks.relative_sigma.assign(kSigmaKnots * 5, 0.01F);
  networks.offset_sigma_siemens.assign(5, 0.0F);
  networks.heaviest_siemens[3] = 1.0F;
  networks.heaviest_newtons[3] = 1000.0F;
  const auto without = networks;
  networks.tables = {{3}, 2, {1e-4F, 4e-4F}, {2.0F, 5.0F}, {0.01F}};
  ASSERT_TRUE(networks.is_consistent());
  std::vector<double> siemens = networks.unloaded.offset_siemens;
  for (double& value : siemens) value += 2e-4;
  const auto force = fuse(networks, make_frame(siemens, 25.0));
  const auto reference = fuse(without, make_frame(siemens, 25.0));
  for (const std::size_t k : {0U, 1U, 2U, 4U}) EXPECT_EQ(force.newtons[k], reference.newtons[k]);
  EXPECT_NEAR(force.newtons[3], 3.0, 1e-4);
  const double exponent = 1e4 * 2e-4 / 3.0;  // slope 3 N / 0.3 mS
  EXPECT_NEAR(force.sigma_newtons[3], 3.0 * std::hypot(0.01, exponent * 1e-6 / 2e-4), 1e-4);
  EXPECT_NEAR(fuse(networks, make_frame(siemens, 35.0)).newtons[3], 3.2, 1e-4);  // s = 1.1 e

  networks.temperature_sigma_celsius = 2.0;
  const double per_celsius = exponent * 0.01;
  EXPECT_NEAR(fuse(networks, make_frame(siemens, 25.0)).sigma_newtons[3],
              3.0 * std::hypot(std::hypot(0.01, exponent * 1e-6 / 2e-4), per_celsius * 2.0), 3e-4);
  siemens[3] = networks.unloaded.offset_siemens[3];
  EXPECT_EQ(fuse(networks, make_frame(siemens, 25.0)).newtons[3], 0.0F);
}

TEST(ForceFusion, tables_of_other_taxels_than_the_networks_are_not_consistent) {
  auto networks = support::random_networks(5, 2, 1, 12);
  networks.tables = {{5}, 1, {1e-4F}, {2.0F}, {0.0F}};
  EXPECT_FALSE(networks.is_consistent());
}

TEST(ForceFusion, temperature_is_clamped_to_the_calibrated_range_and_flagged_beyond_the_sensor_noise) {
  const auto networks = support::random_networks(8, 3, 2, 3);  // 5 ... 45 C
  const std::vector<double> siemens(8, 1e-3);
  for (const double side : {-1.0, 1.0}) {
    const auto at_end = fuse(networks, make_frame(siemens, 25.0 + side * 20.0));
    EXPECT_EQ(at_end.status, FrameStatus::ok);
    const auto a_little_outside = fuse(networks, make_frame(siemens, 25.0 + side * 20.9));
    EXPECT_EQ(a_little_outside.status, FrameStatus::ok);
    EXPECT_EQ(a_little_outside.newtons, at_end.newtons);
    const auto far_outside = fuse(networks, make_frame(siemens, 25.0 + side * 60.0));
    EXPECT_EQ(far_outside.status, FrameStatus::temperature_clamped);
    EXPECT_EQ(far_outside.newtons, at_end.newtons);
  }
}

TEST(ForceFusion, without_a_temperature_the_centre_is_taken_and_flagged) {
  const auto networks = support::random_networks(8, 3, 2, 4);
  const std::vector<double> siemens(8, 1e-3);
  const auto unknown = fuse(networks, make_frame(siemens, {}));
  EXPECT_EQ(unknown.status, FrameStatus::temperature_unknown);
  EXPECT_EQ(unknown.newtons, fuse(networks, make_frame(siemens, 25.0)).newtons);
  EXPECT_NE(unknown.newtons, fuse(networks, make_frame(siemens, 35.0)).newtons);
}

TEST(ForceFusion, networks_that_do_not_know_temperature_do_not_miss_it) {
  EXPECT_EQ(fuse(power_law(), make_frame({1e-3}, {})).status, FrameStatus::ok);
}

TEST(ForceFusion, dead_and_invalid_taxels_have_no_force_and_leave_the_others_alone) {
  auto networks = support::random_networks(4, 2, 1, 5);
  networks.dead[1] = 1;
  auto frame = make_frame(std::vector<double>(4, 1e-3));
  frame.taxels[2] = TaxelStatus::invalid;
  const auto force = fuse(networks, frame);
  EXPECT_TRUE(std::isnan(force.newtons[1]));
  EXPECT_TRUE(std::isnan(force.newtons[2]));
  EXPECT_EQ(force.taxels, (std::vector{TaxelStatus::ok, TaxelStatus::dead, TaxelStatus::invalid, TaxelStatus::ok}));
  EXPECT_EQ(force.status, FrameStatus::dead_taxels);
  for (const std::size_t k : {0U, 3U}) {
    EXPECT_NEAR(force.newtons[k] / support::reference_newtons(networks, k, 1e-3, 0.0), 1.0, 3e-5);
  }
}

TEST(ForceFusion, rejected_frame_has_no_force_at_all) {
  auto frame = make_frame({1e-3, 1e-3}, 20.0);
  frame.status = FrameStatus::rejected;
  frame.taxels.assign(2, TaxelStatus::invalid);
  frame.time = Nanos(5);
  const auto force = fuse(equal_power_laws(2), frame);
  EXPECT_EQ(force.status, FrameStatus::rejected);
  EXPECT_EQ(force.time, Nanos(5));
  ASSERT_EQ(force.newtons.size(), 2U);
  EXPECT_TRUE(std::isnan(force.newtons[0]) && std::isnan(force.newtons[1]));
  EXPECT_EQ(force.taxels, frame.taxels);
}

TEST(ForceFusion, frame_of_another_size_is_rejected) {
  const auto force = fuse(equal_power_laws(2), make_frame({1e-3, 1e-3, 1e-3}, 20.0));
  EXPECT_TRUE(has(force.status, FrameStatus::rejected));
  ASSERT_EQ(force.newtons.size(), 2U);
  EXPECT_TRUE(std::isnan(force.newtons[0]) && std::isnan(force.newtons[1]));
  EXPECT_EQ(force.taxels, std::vector<TaxelStatus>(2, TaxelStatus::invalid));
}

TEST(ForceFusion, conductance_that_is_not_a_number_makes_its_taxel_invalid) {
  const auto force = fuse(equal_power_laws(2), make_frame({kNan, 1e-3 + 1e-5}, 20.0));
  EXPECT_TRUE(std::isnan(force.newtons[0]));
  EXPECT_NEAR(force.newtons[1], 10.0, 1e-4);
  EXPECT_EQ(force.taxels, (std::vector{TaxelStatus::invalid, TaxelStatus::ok}));
  EXPECT_EQ(force.status, FrameStatus::ok);
}

TEST(ForceFusion, flags_of_the_units_before_go_through) {
  auto frame = make_frame({1e-3}, 20.0);
  frame.time = Nanos(77);
  frame.status = FrameStatus::saturated;
  const auto force = fuse(power_law(), frame);
  EXPECT_EQ(force.status, FrameStatus::saturated);
  EXPECT_EQ(force.time, Nanos(77));
}

/// sigma_newtons by the formula of ForceFusion, with derivatives by central differences of the reference network.
double reference_sigma(const ForceNetworks& networks, std::size_t taxel, double siemens, double sigma_siemens,
                       double temperature_offset) {
  const auto log_newtons = [&](double g, double dt) {
    return std::log(support::reference_newtons(networks, taxel, g, dt));
  };
  const double per_siemens =
      (log_newtons(siemens * (1 + 1e-6), temperature_offset) - log_newtons(siemens * (1 - 1e-6), temperature_offset)) /
      (2e-6 * siemens);
  const double per_celsius =
      networks.shape.inputs == 2 && networks.unloaded.per_celsius[taxel] == 0.0
          ? 0.0
          : (log_newtons(siemens, temperature_offset + 1e-4) - log_newtons(siemens, temperature_offset - 1e-4)) / 2e-4;
  const double newtons = support::reference_newtons(networks, taxel, siemens, temperature_offset);
  const double place = networks.sigma_place(static_cast<float>(std::log(newtons)));
  double material = 0.0;
  for (std::size_t k = 0; k < kSigmaKnots; ++k) {
    const double weight = std::max(0.0, 1.0 - std::abs(place - static_cast<double>(k)));
    material += weight * std::pow(static_cast<double>(networks.relative_sigma[k * networks.taxel_count() + taxel]), 2);
  }
  const double conductance = per_siemens * std::hypot(sigma_siemens, networks.offset_sigma_siemens[taxel]);
  const double temperature = per_celsius * networks.temperature_sigma_celsius;
  material += std::pow(0.1 * std::fmax(std::log(networks.sigma_knots_newtons[0] / newtons), 0.0), 2);
  return newtons * std::sqrt(conductance * conductance + temperature * temperature + material);
}

TEST(ForceFusion, sigma_is_the_documented_formula) {
  for (const std::size_t inputs : {2U, 3U}) {
    for (const std::size_t hidden : {0U, 1U, 4U}) {
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(testing::Message() << inputs << "-" << hidden << "-1, seed " << seed);
        Random random(seed);
        const auto networks = support::random_networks(37, inputs, hidden, seed);
        const double offset = random.uniform(-19.0, 19.0);
        std::vector<double> siemens(37);
        for (std::size_t k = 0; k < 37; ++k) {
          siemens[k] = networks.unloaded.offset_siemens[k] + random.log_uniform(2e-5, 1.4e-3);
        }
        auto frame = make_frame(siemens, 25.0 + offset);
        for (double& sigma : frame.sigma_siemens) sigma = random.log_uniform(1e-7, 1e-5);
        const auto force = fuse(networks, frame);
        for (std::size_t k = 0; k < 37; ++k) {
          const double expected = reference_sigma(networks, k, siemens[k], frame.sigma_siemens[k], offset);
          EXPECT_NEAR(force.sigma_newtons[k] / expected, 1.0, 2e-3) << "taxel " << k;
        }
      }
    }
  }
}

TEST(ForceFusion, sigma_of_an_unloaded_taxel_is_its_detection_limit) {
  // 10 N (1e-5 / 1e-3)^0.9 times the exponent: the force of one standard deviation of the conductance.
  const double limit = 0.9 * 10.0 * std::pow(1e-2, 0.9);
  for (const double excess : {-1e-3, -1e-6, 0.0, 1e-12, 1e-7, 5e-6, 1e-5}) {
    auto frame = make_frame({1e-5 + excess}, 20.0);
    frame.sigma_siemens = {1e-5};
    const auto force = fuse(power_law(), frame);
    EXPECT_NEAR(force.sigma_newtons[0] / limit, 1.0, 1e-3) << excess;
  }
  auto frame = make_frame({3e-5}, 20.0);
  frame.sigma_siemens = {1e-5};
  EXPECT_NEAR(fuse(power_law(), frame).sigma_newtons[0], 0.9 * 10.0 * std::pow(2e-2, 0.9) / 2.0, 1e-3);
}

TEST(ForceFusion, a_signal_stands_against_the_additive_noise_alone) {
  ForceNetworks networks = power_law();
  networks.relative_sigma.assign(kSigmaKnots, 0.5F);
  networks.offset_sigma_siemens = {3e-6F};
  auto frame = make_frame({1e-5 + 2e-4}, 20.0);
  frame.sigma_siemens = {4e-6};
  EXPECT_NEAR(fuse(networks, frame).signal_to_noise[0], 2e-4 / 5e-6, 1e-3);
  frame.siemens = {1e-5 - 1e-5};
  EXPECT_NEAR(fuse(networks, frame).signal_to_noise[0], -1e-5 / 5e-6, 1e-3);
}

TEST(ForceFusion, a_drift_that_all_taxels_share_counts_twice_against_a_signal) {
  auto frame = make_frame({1e-5 + 2e-4}, std::nullopt);  // anywhere in 20 C: a standard deviation of 5.77 C
  frame.sigma_siemens = {4e-6};
  EXPECT_NEAR(fuse(power_law(), frame).signal_to_noise[0], 2e-4 / (4e-6 + 2.0 * 1e-6 * 10.0 / std::sqrt(3.0)), 1e-2);
}

TEST(ForceFusion, a_signal_is_missing_where_the_force_is) {
  EXPECT_TRUE(std::isnan(fuse(power_law(), make_frame({kNan}, 20.0)).signal_to_noise[0]));
  auto frame = make_frame({1e-3}, 20.0);
  frame.status = FrameStatus::rejected;
  EXPECT_TRUE(std::isnan(fuse(power_law(), frame).signal_to_noise[0]));
}

TEST(ForceFusion, sigma_is_infinite_where_only_a_lower_bound_is_known) {
  EXPECT_TRUE(std::isinf(fuse(power_law(), make_frame({1.0}, 20.0)).sigma_newtons[0]));  // far above range
  auto frame = make_frame({1e-3}, 20.0);
  frame.taxels[0] = TaxelStatus::saturated;
  EXPECT_TRUE(std::isinf(fuse(power_law(), frame).sigma_newtons[0]));
}

TEST(ForceFusion, sigma_is_positive_where_there_is_a_force_and_nan_where_there_is_none) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    auto networks = support::random_networks(23, 3, 3, seed);
    networks.dead[random.below(23)] = 1;
    std::vector<double> siemens(23);
    for (double& value : siemens) value = random.below(4) == 0 ? 0.0 : random.log_uniform(1e-12, 1.0);
    siemens[random.below(23)] = kNan;
    auto frame = make_frame(siemens, random.uniform(-40.0, 90.0));
    frame.taxels[random.below(23)] = TaxelStatus::line_fault;
    for (double& sigma : frame.sigma_siemens) sigma = random.below(4) == 0 ? 0.0 : random.log_uniform(1e-15, 1e-2);
    const auto force = fuse(networks, frame);
    for (std::size_t k = 0; k < 23; ++k) {
      if (std::isnan(force.newtons[k])) {
        EXPECT_TRUE(std::isnan(force.sigma_newtons[k])) << "taxel " << k;
      } else {
        EXPECT_GT(force.sigma_newtons[k], 0.0F) << "taxel " << k;
      }
    }
  }
}

TEST(ForceFusion, an_unknown_or_far_temperature_costs_certainty) {
  const auto networks = support::random_networks(8, 3, 2, 4);
  const std::vector<double> siemens(8, 1e-3);
  const auto known = fuse(networks, make_frame(siemens, 25.0));
  const auto unknown = fuse(networks, make_frame(siemens, {}));
  const auto at_end = fuse(networks, make_frame(siemens, 45.0));
  const auto outside = fuse(networks, make_frame(siemens, 75.0));
  for (std::size_t k = 0; k < 8; ++k) {
    if (std::isinf(known.sigma_newtons[k])) continue;
    EXPECT_GT(unknown.sigma_newtons[k], known.sigma_newtons[k]);
    EXPECT_GT(outside.sigma_newtons[k], at_end.sigma_newtons[k]);
  }
}

TEST(ForceFusion, a_temperature_in_the_gap_is_as_uncertain_as_the_nearest_calibrated_one_is_far) {
  auto networks = support::random_networks(8, 3, 2, 4);
  const std::vector<double> siemens(8, 1e-3);
  auto with_gap = networks;
  with_gap.temperature_gap_celsius = {15.0, 35.0};
  for (const auto& [celsius, far] : {std::pair(10.0, 0.0), std::pair(18.0, 3.0), std::pair(25.0, 10.0)}) {
    networks.temperature_sigma_celsius = std::hypot(with_gap.temperature_sigma_celsius, far);
    const auto expected = fuse(networks, make_frame(siemens, celsius));
    const auto between = fuse(with_gap, make_frame(siemens, celsius));
    EXPECT_EQ(between.newtons, expected.newtons);
    for (std::size_t k = 0; k < 8; ++k) {
      EXPECT_FLOAT_EQ(between.sigma_newtons[k], expected.sigma_newtons[k]) << celsius << " C";
    }
  }
}

TEST(ForceNetworks, consistent_networks_are_consistent) {
  EXPECT_TRUE(power_law().is_consistent());
  EXPECT_TRUE(equal_power_laws(2).is_consistent());
  for (const std::size_t inputs : {2U, 3U}) EXPECT_TRUE(support::random_networks(9, inputs, 4, 1).is_consistent());
}

TEST(ForceFusion, a_temperature_that_nobody_calibrated_costs_half_a_percent_a_degree) {
  auto networks = support::random_networks(8, 2, 2, 4);
  networks.unloaded.per_celsius.assign(8, 0.0);
  const TemperatureSpan& span = networks.unloaded.temperature;
  const double hottest = span.centre_celsius + span.half_span_celsius;
  std::vector<double> siemens;
  for (const double offset : networks.unloaded.offset_siemens) siemens.push_back(offset + 3e-4);
  const auto calibrated = fuse(networks, make_frame(siemens, hottest));
  const auto hotter = fuse(networks, make_frame(siemens, hottest + 10.0));
  for (std::size_t k = 0; k < 8; ++k) {
    ASSERT_EQ(hotter.newtons[k], calibrated.newtons[k]);
    const double expected = std::hypot(calibrated.sigma_newtons[k], 0.05F * calibrated.newtons[k]);
    EXPECT_NEAR(hotter.sigma_newtons[k] / expected, 1.0, 1e-4) << "taxel " << k;
  }
}

TEST(ForceFusion, temperatures_cost_nothing_where_it_is_not_known_at_which_one_was_calibrated) {
  auto networks = support::random_networks(8, 2, 2, 4);
  networks.unloaded.temperature = {20.0, 0.0};
  networks.unloaded.per_celsius.assign(8, 0.0);
  const std::vector<double> siemens(8, 1e-3);
  const auto without = fuse(networks, make_frame(siemens, {}));
  const auto with = fuse(networks, make_frame(siemens, 45.0));
  for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(with.sigma_newtons[k], without.sigma_newtons[k]);
}

TEST(ForceNetworks, half_span_is_not_negative_even_where_temperature_is_not_an_input) {
  ForceNetworks networks = power_law();
  networks.unloaded.temperature.half_span_celsius = 0.0;
  EXPECT_TRUE(networks.is_consistent());
  networks.unloaded.temperature.half_span_celsius = -1.0;
  EXPECT_FALSE(networks.is_consistent());
}

TEST(ForceNetworks, every_broken_field_is_found) {
  using Break = std::function<void(ForceNetworks&)>;
  constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinityF = std::numeric_limits<float>::infinity();
  const std::vector<std::pair<std::string, Break>> breaks = {
      {"1 input", [](auto& n) { n.shape.inputs = 1; }},
      {"4 inputs", [](auto& n) { n.shape.inputs = 4; }},
      {"another number of hidden units", [](auto& n) { n.shape.hidden = 3; }},
      {"65 hidden units",
       [](auto& n) {
         n.shape.hidden = 65;
         n.parameters.assign(n.shape.parameter_count() * n.taxel_count(), 0.1F);
       }},
      {"centre", [](auto& n) { n.unloaded.temperature.centre_celsius = kNan; }},
      {"half span NaN", [](auto& n) { n.unloaded.temperature.half_span_celsius = kNan; }},
      {"half span 0", [](auto& n) { n.unloaded.temperature.half_span_celsius = 0.0; }},
      {"half span negative", [](auto& n) { n.unloaded.temperature.half_span_celsius = -1.0; }},
      {"offset NaN", [](auto& n) { n.unloaded.offset_siemens[1] = kNan; }},
      {"offset size", [](auto& n) { n.unloaded.offset_siemens.pop_back(); }},
      {"offset drift NaN", [](auto& n) { n.unloaded.per_celsius[1] = kNan; }},
      {"offset drift size", [](auto& n) { n.unloaded.per_celsius.push_back(0.0); }},
      {"reference 0", [](auto& n) { n.reference_siemens[1] = 0.0F; }},
      {"reference infinite", [](auto& n) { n.reference_siemens[1] = kInfinityF; }},
      {"reference size", [](auto& n) { n.reference_siemens.pop_back(); }},
      {"heaviest siemens negative", [](auto& n) { n.heaviest_siemens[1] = -1e-3F; }},
      {"heaviest siemens NaN", [](auto& n) { n.heaviest_siemens[1] = kNanF; }},
      {"heaviest siemens size", [](auto& n) { n.heaviest_siemens.pop_back(); }},
      {"heaviest newtons 0", [](auto& n) { n.heaviest_newtons[1] = 0.0F; }},
      {"heaviest newtons NaN", [](auto& n) { n.heaviest_newtons[1] = kNanF; }},
      {"heaviest newtons size", [](auto& n) { n.heaviest_newtons.pop_back(); }},
      {"gain 0", [](auto& n) { n.gain[1] = 0.0F; }},
      {"gain NaN", [](auto& n) { n.gain[1] = kNanF; }},
      {"gain size", [](auto& n) { n.gain.pop_back(); }},
      {"dead 2", [](auto& n) { n.dead[1] = 2; }},
      {"dead size", [](auto& n) { n.dead.pop_back(); }},
      {"temperature sigma negative", [](auto& n) { n.temperature_sigma_celsius = -0.1; }},
      {"temperature sigma NaN", [](auto& n) { n.temperature_sigma_celsius = kNan; }},
      {"temperature gap falling",
       [](auto& n) {
         n.temperature_gap_celsius = {30.0, 20.0};
       }},
      {"temperature gap NaN",
       [](auto& n) {
         n.temperature_gap_celsius = {20.0, kNan};
       }},
      {"offset sigma negative", [](auto& n) { n.offset_sigma_siemens[1] = -1e-9F; }},
      {"offset sigma size", [](auto& n) { n.offset_sigma_siemens.pop_back(); }},
      {"relative sigma 0", [](auto& n) { n.relative_sigma[1] = 0.0F; }},
      {"gain error NaN",
       [](auto& n) {
         n.gain_errors = {{kNanF, 0.1F}, 1};
       }},
      {"gain errors of other taxels",
       [](auto& n) {
         n.gain_errors = {{0.1F, 0.1F, 0.1F, 0.1F, 0.1F}, 1};
       }},
      {"gain errors without columns", [](auto& n) { n.gain_errors.sigma.assign(n.taxel_count(), 0.1F); }},
      {"more shares than a whole",
       [](auto& n) {
         n.gain_errors.sigma.assign(n.taxel_count(), 0.1F);
         n.gain_errors.cols = 1;
         n.gain_errors.row_share = n.gain_errors.column_share = 0.6;
       }},
      {"relative sigma NaN", [](auto& n) { n.relative_sigma[1] = kNanF; }},
      {"relative sigma size", [](auto& n) { n.relative_sigma.pop_back(); }},
      {"sigma knots not rising",
       [](auto& n) {
         n.sigma_knots_newtons = {5.0F, 5.0F};
       }},
      {"end bends", [](auto& n) { n.end_bends[1] = -1.0F; }},
      {"sigma knot 0", [](auto& n) { n.sigma_knots_newtons[0] = 0.0F; }},
      {"parameter NaN", [](auto& n) { n.parameters.back() = kNanF; }},
      {"parameter infinite", [](auto& n) { n.parameters.front() = kInfinityF; }},
      {"parameters size", [](auto& n) { n.parameters.pop_back(); }},
  };
  for (const auto& [name, damage] : breaks) {
    ForceNetworks networks = support::random_networks(3, 3, 2, 1);
    ASSERT_TRUE(networks.is_consistent());
    damage(networks);
    EXPECT_FALSE(networks.is_consistent()) << name;
  }
}

TEST(ForceFusion, each_taxel_of_a_map_has_the_force_that_its_temperature_gives_to_all) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const ForceNetworks networks = support::random_networks(6, 3, 2, seed);
    ConductanceFrame frame = make_frame(std::vector<double>(6), 25.0);
    for (double& siemens : frame.siemens) siemens = random.uniform(1e-5, 2e-3);
    for (int k = 0; k < 6; ++k) frame.taxel_celsius.push_back(static_cast<float>(random.uniform(0.0, 50.0)));
    const ForceFrame of_map = fuse(networks, frame);
    for (std::size_t taxel = 0; taxel < 6; ++taxel) {
      ConductanceFrame alone = frame;
      alone.taxel_celsius.clear();
      alone.temperature_celsius = frame.taxel_celsius[taxel];
      const ForceFrame of_one = fuse(networks, alone);
      EXPECT_EQ(of_map.newtons[taxel], of_one.newtons[taxel]) << "seed " << seed;
      EXPECT_EQ(of_map.sigma_newtons[taxel], of_one.sigma_newtons[taxel]) << "seed " << seed;
      EXPECT_EQ(of_map.signal_to_noise[taxel], of_one.signal_to_noise[taxel]) << "seed " << seed;
    }
  }
}

TEST(ForceFusion, a_sum_is_as_uncertain_as_the_temperature_of_any_of_its_taxels) {
  const ForceNetworks networks = support::random_networks(4, 3, 2, 7);
  const TemperatureSpan& calibrated = networks.unloaded.temperature;
  ConductanceFrame frame = make_frame(std::vector<double>(4, 1e-3), calibrated.centre_celsius);
  const double calm = fuse(networks, frame).total().sigma_newtons;
  const auto far = static_cast<float>(calibrated.half_span_celsius) + 60.0F;
  const auto centre = static_cast<float>(calibrated.centre_celsius);
  frame.taxel_celsius = {centre + far, centre + far, centre - far, centre - far};
  const ForceFrame force = fuse(networks, frame);
  EXPECT_GT(force.total().sigma_newtons, 10.0 * calm);
}

/// As many taxels of one law: F = 10 N (e / 1 mS)^exponent, without an error of its own.
ForceNetworks equal_laws(std::size_t taxels, float exponent) {
  ForceNetworks networks = equal_power_laws(taxels);
  networks.relative_sigma.assign(kSigmaKnots * taxels, 1e-6F);
  networks.sigma_knots_newtons = {1e-6F, 100.0F};
  std::fill_n(networks.parameters.begin() + static_cast<std::ptrdiff_t>(taxels), taxels, exponent);
  return networks;
}

constexpr double kNoiseSiemens = 1e-6;  // make_frame()

/// Excess conductances of a taxel with noise.
std::vector<double> noisy(std::size_t taxels, double excess, Random& random) {
  std::vector<double> siemens(taxels);
  for (double& value : siemens) value = 1e-5 + excess + kNoiseSiemens * random.normal();
  return siemens;
}

TEST(ForceSumsOfFusion, noise_of_an_unloaded_array_cancels_within_its_standard_deviation) {
  for (const float exponent : {0.8F, 1.0F, 1.2F}) {
    Random random(1);
    const ForceNetworks networks = equal_laws(400, exponent);
    double mean = 0.0;
    double square = 0.0;
    double cut = 0.0;
    constexpr int kFrames = 500;
    for (int frame = 0; frame < kFrames; ++frame) {
      const ForceFrame force = fuse(networks, make_frame(noisy(400, 0.0, random), 20.0));
      const TotalForce total = force.total();
      mean += total.newtons / total.sigma_newtons / kFrames;
      square += std::pow(total.newtons / total.sigma_newtons, 2) / kFrames;
      cut += std::accumulate(force.newtons.begin(), force.newtons.end(), 0.0) / total.sigma_newtons / kFrames;
    }
    EXPECT_NEAR(mean, 0.0, 0.15) << "exponent " << exponent << ", seed 1";
    EXPECT_NEAR(std::sqrt(square), 1.0, 0.25) << "exponent " << exponent << ", seed 1";
    EXPECT_GT(cut, 5.0) << "what a sum of newtons would be";
  }
}

TEST(ForceSumsOfFusion, the_law_is_odd) {
  const ForceNetworks networks = equal_laws(2, 1.2F);
  for (const double excess : {1e-8, 1e-7, 1e-6, 1e-5}) {
    const ForceFrame force = fuse(networks, make_frame({1e-5 + excess, 1e-5 - excess}, 20.0));
    EXPECT_NEAR(force.sums.newtons[0] / -force.sums.newtons[1], 1.0, 1e-3) << excess;
    EXPECT_EQ(force.newtons[1], 0.0F);
  }
}

TEST(ForceSumsOfFusion, noise_does_not_lift_the_mean_of_a_bent_law) {
  for (const float exponent : {0.7F, 1.5F, 2.0F}) {
    Random random(2);
    constexpr double kExcess = 3.0 * kNoiseSiemens;
    constexpr std::size_t kTaxels = 100'000;
    const ForceFrame force = fuse(equal_laws(kTaxels, exponent), make_frame(noisy(kTaxels, kExcess, random), 20.0));
    const double expected = 10.0 * std::pow(kExcess / 1e-3, exponent);
    EXPECT_NEAR(force.total().newtons / (kTaxels * expected), 1.0, 0.01) << "exponent " << exponent << ", seed 2";
  }
}

TEST(ForceSumsOfFusion, the_sum_of_one_loaded_taxel_is_its_force) {
  const auto networks = support::random_networks(7, 3, 2, 5);
  std::vector<double> siemens = networks.unloaded.offset_siemens;
  for (std::size_t k = 0; k < siemens.size(); ++k)
    siemens[k] += 0.5 * static_cast<double>(networks.heaviest_siemens[k]);
  const ForceFrame force = fuse(networks, make_frame(siemens));
  for (std::size_t k = 0; k < siemens.size(); ++k) {
    const TotalForce total = force.total(std::vector<std::size_t>{k});
    EXPECT_NEAR(total.newtons / static_cast<double>(force.newtons[k]), 1.0, 1e-4) << "taxel " << k;
    EXPECT_NEAR(total.sigma_newtons / static_cast<double>(force.sigma_newtons[k]), 1.0, 1e-4) << "taxel " << k;
  }
}

TEST(ForceSumsOfFusion, a_wrong_temperature_moves_all_zeros_alike) {
  ForceNetworks networks = equal_laws(100, 1.0F);
  networks.temperature_sigma_celsius = 0.5;
  const ForceFrame force = fuse(networks, make_frame(std::vector<double>(100, 1e-5), 20.0));
  const double of_zero = 100.0 * 10.0 / 1e-3 * 1e-6 * 0.5;  // taxels, N/S, S/C, C
  EXPECT_NEAR(force.total().sigma_newtons, std::hypot(of_zero, 10.0 * 10.0 / 1e-3 * kNoiseSiemens), 0.01 * of_zero);
}

TEST(ForceSumsOfFusion, dead_and_invalid_taxels_are_left_out_and_saturated_ones_have_no_bound) {
  ForceNetworks networks = equal_laws(4, 1.0F);
  networks.dead[0] = 1;
  ConductanceFrame frame = make_frame(std::vector<double>(4, 1e-4), 20.0);
  frame.taxels[1] = TaxelStatus::invalid;
  EXPECT_EQ(fuse(networks, frame).total().left_out, 2U);
  EXPECT_TRUE(std::isfinite(fuse(networks, frame).total().sigma_newtons));
  frame.taxels[2] = TaxelStatus::saturated;
  EXPECT_TRUE(std::isinf(fuse(networks, frame).total().sigma_newtons));
}

TEST(ForceSumsOfFusion, a_rejected_frame_has_no_sum) {
  ConductanceFrame frame = make_frame(std::vector<double>(2, 1e-4), 20.0);
  frame.status = FrameStatus::rejected;
  const TotalForce total = fuse(equal_laws(2, 1.0F), frame).total();
  EXPECT_TRUE(std::isnan(total.newtons));
  EXPECT_EQ(total.left_out, 2U);
}

}  // namespace
}  // namespace dermis::touch::fusion
