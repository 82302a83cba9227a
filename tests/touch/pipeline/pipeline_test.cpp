// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/pipeline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/line_faults.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/learn/simulation/scene.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/hand_made_model.hpp"
#include "support/random_networks.hpp"

namespace dermis::touch::pipeline {
namespace {

using support::hand_made_model;

std::unique_ptr<Pipeline> make_pipeline(const Model& model) {
  auto pipeline = Pipeline::create(model);
  EXPECT_TRUE(pipeline);
  return std::make_unique<Pipeline>(*std::move(pipeline));
}

/// What the simulated hardware gives for known forces: material, circuit, ADC without noise.
RawFrame measure(const Model& model, const std::vector<double>& newtons, const std::vector<double>& taxel_celsius,
                 double supply_v) {
  std::vector<double> siemens(newtons.size());
  for (std::size_t k = 0; k < newtons.size(); ++k) {
    siemens[k] = support::siemens_under(model, k, newtons[k], taxel_celsius[k]);
  }
  std::vector<double> ratio(newtons.size());
  learn::simulation::ReadoutCircuit::create(model.array)->ratios(siemens, ratio);
  RawFrame raw;
  raw.supply_v = supply_v;
  raw.counts.resize(newtons.size());
  Random random(1);
  learn::simulation::Adc(model.array.readout, 0.0).convert(ratio, supply_v, random, raw.counts);
  return raw;
}

RawFrame measure(const Model& model, const std::vector<double>& newtons, double celsius, double supply_v) {
  RawFrame raw = measure(model, newtons, std::vector<double>(newtons.size(), celsius), supply_v);
  raw.temperature_celsius = celsius;
  return raw;
}

std::vector<double> random_presses(std::size_t taxels, Random& random) {
  std::vector<double> newtons(taxels, 0.0);
  for (double& force : newtons) {
    if (random.below(5) < 2) force = random.log_uniform(1.0, 40.0);
  }
  return newtons;
}

RawFrame random_frame(const Model& model, std::uint64_t seed) {
  Random random(seed);
  RawFrame raw = measure(model, random_presses(model.array.taxel_count(), random), random.uniform(0.0, 50.0),
                         random.uniform(4.5, 5.5));
  raw.time = Nanos(static_cast<std::int64_t>(seed) * 1000);
  return raw;
}

/// A 24-bit converter leaves the inversion's tolerance: 1e-6 of a column of some 10 mS.
void expect_truth(const Model& model, std::uint64_t seed) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  Random random(seed);
  const auto newtons = random_presses(model.array.taxel_count(), random);
  const double celsius = random.uniform(5.0, 45.0);
  ForceFrame force;
  make_pipeline(model)->process(measure(model, newtons, celsius, random.uniform(4.5, 5.5)), force);
  ASSERT_EQ(force.newtons.size(), newtons.size());
  EXPECT_EQ(force.status, FrameStatus::ok) << to_string(force.status);
  for (std::size_t k = 0; k < newtons.size(); ++k) {
    if (newtons[k] > 0.0) {
      EXPECT_NEAR(force.newtons[k] / newtons[k], 1.0, 2e-4) << "taxel " << k;
    } else {
      EXPECT_NEAR(force.newtons[k], 0.0, 2e-3) << "taxel " << k;
    }
  }
}

TEST(Pipeline, forces_of_a_simulated_array_are_the_true_ones) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_truth(hand_made_model(4, 4), seed);
}

TEST(Pipeline, supply_fluctuation_does_not_reach_the_forces_of_a_converter_with_its_own_reference) {
  Model model = hand_made_model(4, 4);
  model.array.readout.adc_reference_v = 5.5;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_truth(model, seed);
}

TEST(Pipeline, arrays_whose_reading_falls_with_pressure_give_the_true_forces) {
  Model model = hand_made_model(4, 4);
  model.array.readout.pressure_raises_reading = false;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_truth(model, seed);
}

TEST(Pipeline, arrays_at_virtual_ground_give_the_true_forces) {
  Model model = hand_made_model(4, 4);
  model.array.readout.circuit = Circuit::transimpedance;
  model.array.readout.load_ohm.assign(4, 100.0);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_truth(model, seed);
}

TEST(Pipeline, a_press_in_a_large_array_leaves_no_ghosts) {
  const Model model = hand_made_model(16, 16);
  std::vector<double> newtons(256, 0.0);
  newtons[model.array.index(3, 4)] = 20.0;
  newtons[model.array.index(3, 9)] = 35.0;
  newtons[model.array.index(11, 4)] = 12.0;  // the fourth corner of the rectangle is the classical ghost
  ForceFrame force;
  make_pipeline(model)->process(measure(model, newtons, 30.0, 5.0), force);
  for (std::size_t k = 0; k < 256; ++k) EXPECT_NEAR(force.newtons[k], newtons[k], 2e-4 * newtons[k] + 2e-3) << k;
}

/// A model whose array has a sensor of temperature in each corner.
Model model_with_sensors() {
  Model model = hand_made_model(4, 4);
  model.array.temperature_sensors = {{0, 0}, {0, 3}, {3, 0}, {3, 3}};
  return model;
}

/// A sheet that is warm at one end, which turns with `angle`, and is read by its sensors.
RawFrame measure_gradient(const Model& model, const std::vector<double>& newtons, double angle) {
  const auto celsius = [angle](double row, double col) {
    return 25.0 + 4.0 * ((row - 1.5) * std::sin(angle) + (col - 1.5) * std::cos(angle));
  };
  std::vector<double> taxels;
  for (const auto& [row, col] : sensors_on_each_taxel(4, 4)) taxels.push_back(celsius(row, col));
  RawFrame raw = measure(model, newtons, taxels, 5.0);
  for (const auto& [row, col] : model.array.temperature_sensors) {
    raw.sensor_celsius.push_back(static_cast<float>(celsius(row, col)));
  }
  return raw;
}

TEST(Pipeline, sensors_of_temperature_give_the_true_forces_where_the_sheet_is_warmer_at_one_end) {
  const Model model = model_with_sensors();
  Model with_one = model;
  with_one.array.temperature_sensors.clear();
  ForceFrame force;
  double worst_of_one = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    const std::vector<double> newtons = random_presses(16, random);
    RawFrame raw = measure_gradient(model, newtons, static_cast<double>(seed));
    make_pipeline(model)->process(raw, force);
    for (std::size_t k = 0; k < 16; ++k) EXPECT_NEAR(force.newtons[k], newtons[k], 2e-3 * newtons[k] + 2e-2) << seed;
    raw.temperature_celsius = 25.0;
    make_pipeline(with_one)->process(raw, force);
    for (std::size_t k = 0; k < 16; ++k) {
      if (newtons[k] > 0.0) worst_of_one = std::max(worst_of_one, std::abs(force.newtons[k] / newtons[k] - 1.0));
    }
  }
  EXPECT_GT(worst_of_one, 0.02) << "one temperature is not enough";
}

TEST(Pipeline, a_tare_under_a_gradient_that_turns_leaves_zero_at_zero) {
  const Model model = model_with_sensors();
  const auto pipeline = make_pipeline(model);
  const std::vector<double> nothing(16, 0.0);
  pipeline->tare(TareOver::drift);
  ForceFrame force;
  for (int k = 0; k < 600; ++k) {
    RawFrame raw = measure_gradient(model, nothing, 0.01 * k);
    raw.time = std::chrono::milliseconds(100 * k);
    pipeline->process(raw, force);
    for (const float newtons : force.newtons) ASSERT_NEAR(newtons, 0.0, 0.02) << "frame " << k;
  }
  EXPECT_EQ(pipeline->last_tare().state, Tare::State::taken);
}

TEST(Pipeline, frames_that_lose_their_sensors_and_regain_them_allocate_nothing) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
  const Model model = model_with_sensors();
  const auto pipeline = make_pipeline(model);
  const std::vector<double> presses(16, 5.0);
  const RawFrame with_sensors = measure_gradient(model, presses, 0.5);
  const RawFrame with_one = measure(model, presses, 25.0, 5.0);
  ForceFrame force;
  pipeline->process(with_one, force);
  const support::AllocationGuard guard;
  pipeline->process(with_sensors, force);
  EXPECT_EQ(guard.count(), 0U);
  const float with_map = force.newtons[0];
  pipeline->process(with_one, force);
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_NEAR(force.newtons[0], 5.0, 2e-3) << "no temperature of the frame before is left";
  EXPECT_NEAR(with_map, 5.0, 2e-2);
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](float x, float y) {
    return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
  });
}

TEST(Pipeline, process_is_the_units_chained_by_hand) {
  Model model = hand_made_model(5, 7);
  model.networks = support::random_networks(35, 3, 2, 9);
  model.networks.dead[3] = 1;
  const auto pipeline = make_pipeline(model);
  preprocessing::Conditioner conditioner(model.array);
  auto compensator = compensation::Compensator::create(model.array);
  ASSERT_TRUE(compensator);
  fusion::ForceFusion fusion(model.networks);
  ConditionedFrame conditioned;
  ConductanceFrame conductance;
  ForceFrame by_hand;
  ForceFrame force;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RawFrame raw = random_frame(model, seed);
    if (seed % 5 == 0) raw.supply_v = -1.0;
    if (seed % 7 == 0) raw.time = Nanos(0);
    if (seed % 11 == 0) raw.temperature_celsius.reset();
    conditioner.process(raw, conditioned);
    compensator->process(conditioned, conductance);
    fusion.process(conductance, by_hand);
    pipeline->process(raw, force);
    EXPECT_EQ(force.time, by_hand.time);
    EXPECT_EQ(force.status, by_hand.status);
    EXPECT_EQ(force.taxels, by_hand.taxels);
    EXPECT_TRUE(same_bits(force.newtons, by_hand.newtons));
    EXPECT_EQ(pipeline->conditioned().ratio, conditioned.ratio);
    EXPECT_EQ(pipeline->conductance().siemens, conductance.siemens);
    EXPECT_EQ(pipeline->rejection(), conditioner.rejection());
  }
}

TEST(Pipeline, what_the_material_remembers_is_taken_off_the_forces_of_the_networks) {
  const Model without = hand_made_model(3, 4);
  Model model = without;
  model.memory = fusion::MemoryLaw{{0.05F, 0.1F, 0.1F, 0.15F}, {0.02F, 0.03F, 0.03F}};
  const auto pipeline = make_pipeline(model);
  const auto of_networks = make_pipeline(without);
  fusion::MaterialMemory memory(*model.memory, 12);
  ForceFrame force;
  ForceFrame by_hand;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RawFrame raw = random_frame(model, seed);
    raw.time = std::chrono::milliseconds(37 * seed * seed);
    if (seed % 5 == 0) raw.supply_v = -1.0;
    pipeline->process(raw, force);
    of_networks->process(raw, by_hand);
    const std::vector<float> sigma_of_networks = by_hand.sigma_newtons;
    memory.process(by_hand, std::vector<float>(12));
    EXPECT_EQ(force.status, by_hand.status);
    EXPECT_TRUE(same_bits(force.newtons, by_hand.newtons));
    for (std::size_t taxel = 0; taxel < 12; ++taxel) {
      EXPECT_FALSE(force.sigma_newtons[taxel] < sigma_of_networks[taxel]);
    }
  }
  model.memory->creep[0] = 0.7F;  // more than the inverse can undo
  EXPECT_FALSE(Pipeline::create(model));
}

TEST(Pipeline, frames_influence_each_other_far_below_their_noise) {
  const Model model = hand_made_model(6, 6);
  const auto pipeline = make_pipeline(model);
  ForceFrame force;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const RawFrame raw = random_frame(model, seed);
    ForceFrame alone;
    make_pipeline(model)->process(raw, alone);
    pipeline->process(raw, force);
    for (std::size_t taxel = 0; taxel < alone.newtons.size(); ++taxel) {
      EXPECT_NEAR(force.newtons[taxel], alone.newtons[taxel], 0.05F * alone.sigma_newtons[taxel]) << taxel;
    }
  }
}

/// A round contact that leaves the edges alone.
std::vector<double> round_contact(const ArrayDescription& array, double most_newtons) {
  std::vector<double> newtons(array.taxel_count());
  for (std::size_t taxel = 0; taxel < newtons.size(); ++taxel) {
    const std::size_t row_index = taxel / array.cols;
    const double row = static_cast<double>(row_index) - 3.3;
    const double col = static_cast<double>(taxel % array.cols) - 3.6;
    const double force = most_newtons * std::exp(-(row * row + col * col) / (2.0 * 1.3 * 1.3));
    if (force > 0.1) newtons[taxel] = force;
  }
  return newtons;
}

/// Largest error of the forces beside one taxel, as a share of the force there and a hundredth of the largest.
double worst_error_beside(std::size_t left_out, const std::vector<double>& newtons, const ForceFrame& force) {
  const double largest = *std::max_element(newtons.begin(), newtons.end());
  double worst = 0.0;
  for (std::size_t taxel = 0; taxel < newtons.size(); ++taxel) {
    if (taxel == left_out) continue;
    const double error = std::abs(static_cast<double>(force.newtons[taxel]) - newtons[taxel]);
    if (!(error <= worst * (newtons[taxel] + 0.01 * largest))) worst = error / (newtons[taxel] + 0.01 * largest);
  }
  return worst;
}

TEST(Pipeline, a_taxel_without_a_reading_costs_its_own_force_alone) {
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    Model model = hand_made_model(8, 8);
    model.array.readout.circuit = circuit;
    const std::vector<double> newtons = round_contact(model.array, 20.0);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -7.0F, 1e9F}) {
      for (const std::size_t taxel : {model.array.index(3, 4), model.array.index(2, 3), model.array.index(7, 7)}) {
        SCOPED_TRACE(testing::Message() << to_string(circuit) << ", " << bad << " at "
                                        << model.array.taxel_name(taxel));
        const auto pipeline = make_pipeline(model);
        RawFrame raw = measure(model, newtons, 25.0, 5.0);
        raw.counts[taxel] = bad;
        ForceFrame force;
        for (int frame = 0; frame < 100; ++frame) pipeline->process(raw, force);
        EXPECT_EQ(force.status, FrameStatus::ok) << to_string(force.status);
        EXPECT_EQ(force.taxels[taxel], TaxelStatus::invalid);
        EXPECT_TRUE(std::isnan(force.newtons[taxel]));
        EXPECT_LT(worst_error_beside(taxel, newtons, force), 0.05);
      }
    }
  }
}

TEST(Pipeline, a_taxel_that_is_pinned_to_the_end_of_the_adc_does_not_take_the_others_with_it) {
  const Model model = hand_made_model(8, 8);
  const std::vector<double> newtons = round_contact(model.array, 20.0);
  const std::size_t pinned = model.array.index(2, 3);
  RawFrame raw = measure(model, newtons, 25.0, 5.0);
  raw.counts[pinned] = static_cast<float>(model.array.readout.full_scale_counts());
  ForceFrame force;
  make_pipeline(model)->process(raw, force);
  EXPECT_FALSE(has(force.status, FrameStatus::not_converged));
  EXPECT_EQ(force.taxels[pinned], TaxelStatus::invalid);
  EXPECT_LT(worst_error_beside(pinned, newtons, force), 0.05);
}

TEST(Pipeline, taxels_that_the_sheet_does_not_have_have_no_force_and_disturb_no_other) {
  Model model = hand_made_model(8, 8);
  model.array.absent = {0, 1, 26, 63};
  const std::vector<double> newtons = round_contact(model.array, 20.0);
  std::vector<double> siemens(newtons.size());
  for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
    siemens[taxel] = model.array.is_absent(taxel) ? 0.0 : support::siemens_under(model, taxel, newtons[taxel], 25.0);
  }
  std::vector<double> ratio(newtons.size());
  learn::simulation::ReadoutCircuit::create(model.array)->ratios(siemens, ratio);
  RawFrame raw;
  raw.temperature_celsius = 25.0;
  raw.supply_v = 5.0;
  raw.counts.resize(newtons.size());
  Random random(1);
  learn::simulation::Adc(model.array.readout, 0.0).convert(ratio, 5.0, random, raw.counts);
  raw.counts[1] = std::numeric_limits<float>::quiet_NaN();
  raw.counts[26] = 3000.0F;
  ForceFrame force;
  make_pipeline(model)->process(raw, force);
  EXPECT_EQ(force.status, FrameStatus::ok) << to_string(force.status);
  for (std::size_t taxel = 0; taxel < newtons.size(); ++taxel) {
    if (model.array.is_absent(taxel)) {
      EXPECT_TRUE(std::isnan(force.newtons[taxel])) << taxel;
    } else {
      EXPECT_NEAR(force.newtons[taxel], newtons[taxel], 2e-4 * newtons[taxel] + 2e-3) << taxel;
    }
  }
}

TEST(Pipeline, rejected_frame_says_why_and_has_no_force) {
  const Model model = hand_made_model(2, 2);
  const auto pipeline = make_pipeline(model);
  RawFrame raw = random_frame(model, 1);
  std::fill(raw.counts.begin() + 1, raw.counts.end(), std::numeric_limits<float>::quiet_NaN());
  ForceFrame force;
  pipeline->process(raw, force);
  EXPECT_EQ(force.status, FrameStatus::rejected);
  EXPECT_EQ(pipeline->rejection(), preprocessing::Rejection::too_few_readings);
  ASSERT_EQ(force.newtons.size(), 4U);
  for (const float newtons : force.newtons) EXPECT_TRUE(std::isnan(newtons));
  EXPECT_EQ(force.taxels, std::vector<TaxelStatus>(4, TaxelStatus::invalid));
  raw.counts.pop_back();
  pipeline->process(raw, force);
  EXPECT_EQ(pipeline->rejection(), preprocessing::Rejection::wrong_shape);
  EXPECT_EQ(force.newtons.size(), 4U);
  pipeline->process(random_frame(model, 2), force);
  EXPECT_EQ(force.status, FrameStatus::ok);
  EXPECT_EQ(pipeline->rejection(), preprocessing::Rejection::none);
}

/// hand_made_model() with an ADC whose reference is in volts, calibrated at 4.5 to 5.5 V.
Model model_at_5_volts() {
  Model model = hand_made_model(4, 4);
  model.array.readout.adc_reference_v = 5.0;
  model.array.readout.supply_v = 5.0;
  model.supply = preprocessing::SupplyRange{4.5, 5.5};
  return model;
}

TEST(Pipeline, a_supply_that_is_told_wrong_is_flagged_or_rejected_and_sigma_covers_the_error) {
  const Model model = model_at_5_volts();
  Random random(5);
  const std::vector<double> newtons = random_presses(16, random);
  RawFrame raw = measure(model, newtons, 25.0, 5.3);
  ForceFrame right;
  make_pipeline(model)->process(raw, right);
  ASSERT_EQ(right.status, FrameStatus::ok);
  for (const double told_v : {0.1, 1.0, 1.7, 2.0, 3.0, 4.0, 4.3, 5.7, 6.5, 10.0, 14.0, 50.0, 5000.0, 1e308}) {
    SCOPED_TRACE(testing::Message() << told_v << " V");
    raw.supply_v = told_v;
    ForceFrame force;
    make_pipeline(model)->process(raw, force);
    const bool is_possible = told_v > 5.0 / 3.0 && told_v < 15.0;
    EXPECT_EQ(has(force.status, FrameStatus::rejected), !is_possible);
    if (!is_possible) continue;
    EXPECT_TRUE(has(force.status, FrameStatus::supply_clamped | FrameStatus::supply_implausible));
    for (std::size_t k = 0; k < newtons.size(); ++k) {
      if (newtons[k] == 0.0) continue;
      EXPECT_NEAR(force.newtons[k], right.newtons[k], 2.0F * force.sigma_newtons[k]) << k;
      EXPECT_LT(force.newtons[k], 1.5F * right.newtons[k]) << k;
      EXPECT_GT(force.sigma_newtons[k], right.sigma_newtons[k]) << k;
    }
  }
}

TEST(Pipeline, sigma_grows_with_the_distance_of_the_supply_from_the_calibration) {
  const Model model = model_at_5_volts();
  Random random(5);
  RawFrame raw = measure(model, random_presses(16, random), 25.0, 5.0);
  ForceFrame force;
  double last = 0.0;
  for (const double supply_v : {5.5, 5.8, 6.2, 8.0, 12.0}) {
    raw.supply_v = supply_v;
    make_pipeline(model)->process(raw, force);
    double relative = 0.0;
    for (std::size_t k = 0; k < 16; ++k) {
      if (force.newtons[k] > 1.0F) relative += static_cast<double>(force.sigma_newtons[k] / force.newtons[k]);
    }
    EXPECT_GT(relative, last) << supply_v;
    last = relative;
  }
}

TEST(Pipeline, says_what_was_wrong_with_a_rejected_frame) {
  const Model model = model_at_5_volts();
  const auto pipeline = make_pipeline(model);
  RawFrame raw = random_frame(model, 1);
  ForceFrame force;
  pipeline->process(raw, force);
  EXPECT_EQ(pipeline->why_rejected(), "");
  raw.supply_v = 4987.0;
  pipeline->process(raw, force);
  EXPECT_EQ(pipeline->why_rejected(),
            "a supply of 4987 V (1.67 to 15 V are possible): it looks like millivolts, give volts");
  raw.supply_v = 5.0;
  raw.counts.pop_back();
  pipeline->process(raw, force);
  EXPECT_EQ(pipeline->why_rejected(), "wrong number of readings");
}

TEST(Pipeline, statuses_of_all_units_meet_in_the_frame) {
  Model model = hand_made_model(2, 2);
  model.array.readout.circuit = Circuit::transimpedance;
  model.array.readout.load_ohm.assign(2, 50.0);
  model.networks.dead[3] = 1;
  model.networks.heaviest_siemens.assign(4, 1e-4F);
  const auto pipeline = make_pipeline(model);
  const auto full_scale = static_cast<float>(model.array.readout.full_scale_counts());
  RawFrame raw;
  raw.counts = {full_scale, 0.0F, 0.3F * full_scale, 0.0F};
  raw.temperature_celsius = 80.0;
  ForceFrame force;
  pipeline->process(raw, force);
  EXPECT_EQ(to_string(force.status), "saturated+above_range+dead_taxels+temperature_clamped");
  EXPECT_EQ(force.taxels,
            (std::vector{TaxelStatus::saturated, TaxelStatus::ok, TaxelStatus::above_range, TaxelStatus::dead}));
  raw.temperature_celsius.reset();
  raw.counts = {0.0F, 0.0F, 0.0F, 0.0F};
  pipeline->process(raw, force);
  EXPECT_EQ(to_string(force.status), "dead_taxels+temperature_unknown");
}

TEST(Pipeline, frame_without_a_solution_is_flagged_and_has_no_force) {
  Model model = hand_made_model(2, 2);
  model.array.readout.circuit = Circuit::transimpedance;
  model.array.readout.load_ohm.assign(2, 20.0);  // full scale on both columns draws 2 supplies through the driver
  const auto pipeline = make_pipeline(model);
  RawFrame raw;
  raw.temperature_celsius = 25.0;
  raw.counts.assign(4, static_cast<float>(model.array.readout.full_scale_counts()));
  ForceFrame force;
  pipeline->process(raw, force);
  EXPECT_EQ(force.status, FrameStatus::saturated | FrameStatus::not_converged);
  for (const float newtons : force.newtons) EXPECT_TRUE(std::isnan(newtons));
}

TEST(Pipeline, circuit_that_is_still_to_be_fitted_is_refused) {
  Model model = hand_made_model(2, 2);
  model.array.readout.drive_ohm[1] = kFitOhm;
  const auto pipeline = Pipeline::create(model);
  ASSERT_FALSE(pipeline);
  EXPECT_EQ(pipeline.error().kind, ErrorKind::bad_input);
}

TEST(Pipeline, networks_that_do_not_fit_the_array_are_refused) {
  Model model = hand_made_model(2, 2);
  model.networks = support::random_networks(5, 3, 1, 1);
  EXPECT_FALSE(Pipeline::create(model));
  model = hand_made_model(2, 2);
  model.networks.gain[0] = 0.0F;
  EXPECT_FALSE(Pipeline::create(model));
  model = hand_made_model(2, 2);
  model.array.readout.load_ohm.pop_back();
  EXPECT_FALSE(Pipeline::create(model));
}

TEST(Pipeline, impossible_readings_never_give_a_force_without_a_flag) {
  const Model model = hand_made_model(8, 8);
  const auto pipeline = make_pipeline(model);
  const double full_scale = model.array.readout.full_scale_counts();
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    RawFrame raw;
    raw.temperature_celsius = 25.0;
    raw.counts.resize(64);
    for (float& count : raw.counts) count = static_cast<float>(std::floor(random.uniform() * full_scale));
    ForceFrame force;
    pipeline->process(raw, force);
    for (std::size_t k = 0; k < 64; ++k) {
      EXPECT_EQ(std::isnan(force.newtons[k]), force.taxels[k] == TaxelStatus::invalid);
    }
  }
}

TEST(AllocationGuard, sees_allocations_of_every_kind) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
  const auto count_of = [](auto allocate) {
    const support::AllocationGuard guard;
    allocate();
    return guard.count();
  };
  std::vector<float> sink;
  EXPECT_EQ(count_of([] {}), 0U);
  EXPECT_EQ(count_of([&] { sink.resize(100); }), 1U);
  EXPECT_EQ(count_of([&] { sink.resize(50); }), 0U);
  void* volatile block = nullptr;
  EXPECT_EQ(count_of([&] { block = std::malloc(10); }), 1U);
  std::free(block);
  EXPECT_EQ(count_of([&] { block = std::aligned_alloc(64, 128); }), 1U);
  std::free(block);
  EXPECT_EQ(count_of([&] { block = std::calloc(2, 8); }), 1U);
  void* volatile larger = nullptr;
  EXPECT_EQ(count_of([&] { larger = std::realloc(block, 4096); }), 1U);
  std::free(larger);
}

/// Frames of every kind: good, saturated, without temperature, rejected for each reason, without a solution.
std::vector<RawFrame> frames_of_every_kind(const Model& model) {
  std::vector<RawFrame> frames;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) frames.push_back(random_frame(model, seed));
  const auto full_scale = static_cast<float>(model.array.readout.full_scale_counts());
  const auto add = [&](auto change) {
    RawFrame raw = frames.front();
    raw.time = frames.back().time;
    change(raw);
    frames.push_back(raw);
  };
  add([](RawFrame& raw) { raw.temperature_celsius.reset(); });
  add([](RawFrame& raw) { raw.temperature_celsius = 400.0; });
  add([&](RawFrame& raw) { raw.counts[1] = full_scale; });
  add([&](RawFrame& raw) { raw.counts.assign(raw.counts.size(), full_scale); });
  add([](RawFrame& raw) { raw.counts.clear(); });
  add([](RawFrame& raw) { raw.counts.resize(3 * raw.counts.size()); });
  add([](RawFrame& raw) { raw.counts[0] = std::numeric_limits<float>::quiet_NaN(); });
  add([](RawFrame& raw) { raw.counts[0] = -1.0F; });
  add([](RawFrame& raw) { raw.supply_v = 0.0; });
  frames.push_back(frames.front());  // time going backwards
  return frames;
}

TEST(Pipeline, allocates_nothing_after_the_first_frame) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc: allocations cannot be counted";
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance, Circuit::none}) {
    Model model = hand_made_model(8, 9);
    model.array.readout.circuit = circuit;
    model.networks.tables = {{5, 50}, 1, {1e-3F, 1e-3F}, {9.0F, 11.0F}, {0.01F, 0.0F}};
    model.memory = fusion::MemoryLaw{{0.1F, 0.1F, 0.1F, 0.1F}, {0.02F, 0.02F, 0.02F}};
    const auto frames = frames_of_every_kind(model);
    for (std::size_t first = 0; first < frames.size(); ++first) {
      SCOPED_TRACE(testing::Message() << to_string(circuit) << ", first frame " << first);
      const auto pipeline = make_pipeline(model);
      ForceFrame force;
      pipeline->process(frames[first], force);
      FrameStatus seen = FrameStatus::ok;
      const support::AllocationGuard guard;
      for (const RawFrame& frame : frames) {
        pipeline->process(frame, force);
        seen |= force.status;
      }
      const std::size_t allocations = guard.count();
      EXPECT_EQ(allocations, 0U);
      EXPECT_TRUE(has(seen, FrameStatus::rejected));
    }
  }
}

/// Mean forces of `seconds` at 10 frames/s of an array under constant forces that warms up evenly.
std::vector<double> live(Pipeline& pipeline, const Model& model, const std::vector<double>& newtons, double seconds,
                         double from_celsius, double to_celsius) {
  static std::int64_t now_ns = 0;
  const int frames = static_cast<int>(10.0 * seconds);
  std::vector<double> mean(newtons.size(), 0.0);
  ForceFrame force;
  for (int i = 0; i < frames; ++i) {
    const double celsius = from_celsius + (to_celsius - from_celsius) * i / frames;
    RawFrame raw = measure(model, newtons, celsius, 5.0);
    now_ns += 100'000'000;
    raw.time = Nanos(now_ns);
    pipeline.process(raw, force);
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += static_cast<double>(force.newtons[k]) / frames;
  }
  return mean;
}

TEST(Pipeline, a_press_of_ten_minutes_loses_less_than_a_hundredth_while_it_warms_up_by_ten_celsius) {
  const Model model = hand_made_model(4, 5);
  const auto pipeline = make_pipeline(model);
  pipeline->drift().set_options({.track = true});
  std::vector<double> newtons(20, 0.0);
  live(*pipeline, model, newtons, 60.0, 20.0, 20.0);
  newtons[6] = 5.0;
  newtons[13] = 0.1;
  live(*pipeline, model, newtons, 600.0, 20.0, 30.0);
  const std::vector<double> after = live(*pipeline, model, newtons, 2.0, 30.0, 30.0);
  EXPECT_NEAR(after[6], 5.0, 0.005 * 5.0);
  EXPECT_NEAR(after[13], 0.1, 0.01 * 0.1);
  newtons.assign(20, 0.0);
  for (const double force_n : live(*pipeline, model, newtons, 2.0, 30.0, 30.0)) EXPECT_LT(force_n, 0.001);
}

TEST(Pipeline, ten_minutes_of_constant_load_on_a_material_that_creeps_keep_their_force) {
  Model model = hand_made_model(4, 5);
  model.memory = fusion::MemoryLaw{{0.05F, 0.1F, 0.1F, 0.15F}, {}};
  const auto pipeline = make_pipeline(model);
  pipeline->drift().set_options({.track = true});
  constexpr double kLoad = 5.0;
  const auto material_after = [&](double seconds) {
    double felt = kLoad;
    for (std::size_t k = 0; k < model.memory->creep.size(); ++k) {
      felt -= kLoad * static_cast<double>(model.memory->creep[k]) *
              std::exp(-seconds / fusion::MemoryLaw::kCreepSeconds[k]);
    }
    return felt;
  };
  ForceFrame force;
  for (int frame = 0; frame < 7000; ++frame) {
    const double seconds = 0.1 * (frame - 600);  // after the load came; it goes after ten minutes
    const bool is_loaded = seconds >= 0.0 && seconds < 600.0;
    std::vector<double> felt(20, 0.0);
    if (is_loaded) felt[6] = material_after(seconds + 0.1);
    RawFrame raw = measure(model, felt, 25.0, 5.0);
    raw.time = std::chrono::milliseconds(100 * frame);
    pipeline->process(raw, force);
    if (is_loaded) {
      ASSERT_NEAR(force.newtons[6], kLoad, 0.01 * kLoad) << seconds << " s";
    } else {
      ASSERT_LT(force.newtons[6], 0.01F) << seconds << " s";
    }
    ASSERT_GE(force.newtons[6], 0.0F);
  }
}

TEST(Pipeline, tracking_takes_an_old_calibration_back_to_zero) {
  const Model model = hand_made_model(4, 5);
  Model aged = model;
  for (double& offset : aged.networks.unloaded.offset_siemens) offset *= 1.08;
  const std::vector<double> unloaded(20, 0.0);
  const auto ghost = [&](bool track) {
    const auto pipeline = make_pipeline(model);
    pipeline->drift().set_options({.track = track});
    live(*pipeline, aged, unloaded, 90.0, 25.0, 25.0);
    const auto forces = live(*pipeline, aged, unloaded, 2.0, 25.0, 25.0);
    return *std::max_element(forces.begin(), forces.end());
  };
  EXPECT_LT(ghost(true), 0.2 * ghost(false));
}

TEST(Pipeline, a_tare_moves_zero_and_health_still_sees_the_array_as_it_is) {
  const Model model = hand_made_model(4, 5);
  const auto pipeline = make_pipeline(model);
  std::vector<double> newtons(20, 0.5);
  pipeline->tare(TareOver::any_load);
  live(*pipeline, model, newtons, 2.0, 25.0, 25.0);
  ASSERT_FALSE(pipeline->drift().taring());
  for (const double force_n : live(*pipeline, model, newtons, 1.0, 25.0, 25.0)) EXPECT_NEAR(force_n, 0.0, 1e-3);
  newtons[7] = 10.5;
  EXPECT_NEAR(live(*pipeline, model, newtons, 1.0, 25.0, 25.0)[7], 10.0, 0.3) << "the material is not quite linear";
  newtons.assign(20, 0.0);
  live(*pipeline, model, newtons, 60.0, 25.0, 25.0);
  EXPECT_EQ(pipeline->conductance().siemens, newtons) << "below zero is zero";
  EXPECT_TRUE(pipeline->line_faults().faults().empty());
  pipeline->drift().reset();
  newtons[7] = 10.0;
  EXPECT_NEAR(live(*pipeline, model, newtons, 1.0, 25.0, 25.0)[7], 10.0, 0.01);
}

/// Several contacts on the reference circuit with 12 bit and 1 count of noise; row 5 breaks in frame 20.
TEST(Pipeline, open_row_is_found_and_masked_and_the_rest_stays_right) {
  constexpr std::size_t kFrames = 300;
  constexpr std::size_t kFrom = 20;
  constexpr std::size_t kRow = 5;
  Model model = hand_made_model(16, 16);
  model.array.readout.adc_bits = 12;
  learn::simulation::LineFaults faults;
  faults.rows.open = {kRow};
  faults.from_frame = kFrom;
  const auto circuit = learn::simulation::FaultyCircuit::create(model.array, faults).value();
  const auto scene = learn::simulation::Scene::create("multitouch", model.array, {}, 8, kFrames).value();
  const learn::simulation::Adc adc(model.array.readout, 1.0);
  const auto broken = make_pipeline(model);
  const auto whole = make_pipeline(model);
  std::vector<double> siemens(model.array.taxel_count());
  std::vector<double> ratio(siemens.size());
  std::vector<double> broken_errors;
  std::vector<double> whole_errors;
  learn::simulation::SceneFrame truth;
  RawFrame raw;
  raw.counts.resize(siemens.size());
  ForceFrame broken_force;
  ForceFrame whole_force;
  std::size_t found_at = 0;
  const auto measure = [&](std::size_t fault_frame, std::uint64_t seed) {
    circuit.ratios(siemens, fault_frame, ratio);
    Random random(seed);
    adc.convert(ratio, 5.0, random, raw.counts);
  };
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    scene.frame(frame, truth);
    raw.time = std::chrono::seconds(frame);
    raw.temperature_celsius = 25.0;
    for (std::size_t k = 0; k < siemens.size(); ++k)
      siemens[k] = support::siemens_under(model, k, truth.force_n[k], 25.0);
    measure(0, frame);
    whole->process(raw, whole_force);
    measure(frame, frame);
    broken->process(raw, broken_force);
    ASSERT_FALSE(has(whole_force.status, FrameStatus::line_fault));
    if (!has(broken_force.status, FrameStatus::line_fault)) continue;
    if (found_at == 0) found_at = frame;
    for (std::size_t k = 0; k < siemens.size(); ++k) {
      if (k / 16 == kRow) {
        EXPECT_TRUE(std::isnan(broken_force.newtons[k]));
        EXPECT_EQ(broken_force.taxels[k], TaxelStatus::line_fault);
      } else if (truth.force_n[k] >= 1.0) {
        broken_errors.push_back(std::abs(static_cast<double>(broken_force.newtons[k]) / truth.force_n[k] - 1.0));
        whole_errors.push_back(std::abs(static_cast<double>(whole_force.newtons[k]) / truth.force_n[k] - 1.0));
      }
    }
  }
  EXPECT_GE(found_at, kFrom);
  EXPECT_LE(found_at, kFrom + 10);
  EXPECT_GT(broken_errors.size(), 5000U);
  EXPECT_LE(quantile(broken_errors, 0.5), 1.2 * quantile(whole_errors, 0.5));
  EXPECT_LE(quantile(broken_errors, 0.95), 1.2 * quantile(whole_errors, 0.95));
  ASSERT_EQ(broken->line_faults().faults().size(), 1U);
  EXPECT_EQ(broken->line_faults().faults()[0].frame, kFrom);
}

}  // namespace
}  // namespace dermis::touch::pipeline
