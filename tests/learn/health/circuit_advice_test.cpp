// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/circuit_advice.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/hand_made_model.hpp"

namespace dermis::learn::health {
namespace {

constexpr TaxelRange kTaxels{1e3, 1e5};

/// 4 x 5 taxels, 12 bits, 20 ohm drivers, 200 ohm loads.
ArrayDescription divider() {
  ArrayDescription array = support::hand_made_model(4, 5).array;
  array.readout.adc_bits = 12;
  return array;
}

CircuitAdvice advice_for(const ArrayDescription& array) {
  Result<CircuitAdvice> advice = advise_circuit(array, kTaxels, [](double) {});
  EXPECT_TRUE(advice);
  return *std::move(advice);
}

TEST(CircuitAdvice, noise_of_the_adc_over_the_supply) {
  ArrayDescription array = divider();
  EXPECT_DOUBLE_EQ(*adc_noise_ratio(array), 1.0 / 4095.0);
  array.readout.adc_noise_counts = 2.0;
  array.readout.adc_reference_v = 3.0;
  array.readout.supply_v = 5.0;
  EXPECT_DOUBLE_EQ(*adc_noise_ratio(array), 2.0 * 0.6 / 4095.0);
}

TEST(CircuitAdvice, a_reference_in_volts_needs_the_supply) {
  ArrayDescription array = divider();
  array.readout.adc_reference_v = 3.0;
  const Result<CircuitAdvice> advice = advise_circuit(array, kTaxels, [](double) {});
  ASSERT_FALSE(advice);
  EXPECT_EQ(advice.error().kind, ErrorKind::bad_input);
  EXPECT_NE(advice.error().message.find("readout.supply_v"), std::string::npos);
}

TEST(CircuitAdvice, the_best_load_has_the_least_mean_and_the_loads_rise) {
  const CircuitAdvice advice = advice_for(divider());
  ASSERT_LT(advice.best, advice.loads.size());
  ASSERT_TRUE(advice.loads[advice.best].precision);
  const double least = advice.loads[advice.best].precision->mean;
  for (std::size_t k = 0; k < advice.loads.size(); ++k) {
    EXPECT_GT(advice.loads[k].load_ohm, k == 0 ? 0.0 : advice.loads[k - 1].load_ohm);
    EXPECT_GE(advice.loads[k].precision.value_or(Precision{least}).mean, least);
  }
  ASSERT_TRUE(advice.present);
  EXPECT_LE(least, advice.present->mean);
  EXPECT_LE(advice.present->median, advice.present->p95);
  EXPECT_LE(advice.present->p95, advice.present->worst);
}

TEST(CircuitAdvice, it_keeps_its_word_on_load_and_drivers) {
  ArrayDescription array = divider();
  const CircuitAdvice advice = advice_for(array);
  array.readout.load_ohm.assign(array.cols, advice.loads[advice.best].load_ohm);
  EXPECT_DOUBLE_EQ(advice_for(array).present->mean, advice.loads[advice.best].precision->mean);
  array.readout.drive_ohm.assign(array.rows, advice.most_drive_ohm);
  ASSERT_TRUE(advice.ideal_drivers);
  EXPECT_NEAR(advice_for(array).present->mean / advice.ideal_drivers->mean, 1.1, 0.01);
}

TEST(CircuitAdvice, progress_rises_from_0_and_stays_within_1) {
  double last = -1.0;
  double first = -1.0;
  const auto watch = [&](double share) {
    if (first < 0.0) first = share;
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1.0);
    last = share;
  };
  EXPECT_TRUE(advise_circuit(divider(), kTaxels, watch));
  EXPECT_EQ(first, 0.0);
  EXPECT_GT(last, 0.8);
}

TEST(CircuitAdvice, no_load_serves_an_adc_whose_reference_is_too_low) {
  ArrayDescription array = divider();
  array.readout.circuit = Circuit::transimpedance;
  array.readout.adc_reference_v = 1e-6;
  array.readout.supply_v = 5.0;
  const Result<CircuitAdvice> advice = advise_circuit(array, kTaxels, [](double) {});
  ASSERT_FALSE(advice);
  EXPECT_EQ(advice.error().message,
            "no load resistance brings all readings into the range of the ADC; raise its reference");
}

TEST(CircuitAdvice, its_words_name_the_array_the_load_and_the_drivers) {
  ArrayDescription array = divider();
  array.readout.drive_ohm[1] = 1200.0;
  CircuitAdvice advice;
  advice.taxels = kTaxels;
  advice.noise_ratio = 1.0 / 4095.0;
  advice.loads = {
      {1.0, Precision{9.0, 9.0, 9.0, 9.0}}, {100.0, std::nullopt}, {470.0, Precision{0.01, 0.02, 0.5, 1.5}}};
  advice.best = 2;
  EXPECT_EQ(
      describe(advice, array),
      "4 x 5 taxels of 1 kohm to 100 kohm, divider, idle rows grounded, idle columns loaded, drivers of 20 ohm to "
      "1.2 kohm, noise of a reading 0.024 % of the supply.\n"
      "Relative 1-sigma of a conductance in one frame:\n"
      "\n"
      "        load        mean      median        95 %       worst\n"
      "     100 ohm   readings beyond the ADC or without a solution\n"
      "     470 ohm         1 %         2 %        50 %       150 %   best\n"
      "\n"
      "Load: take 470 ohm on every line: 1 % in the mean, at most 2 % for half of the pressed taxels, 50 % for 95 %, "
      "150 % for the worst.\n"
      "      Now, with 200 ohm: readings beyond the ADC or without a solution.\n"
      "Drive: ideal drivers would bring readings beyond the ADC.\n");
  advice.ideal_drivers = Precision{0.009, 0.018, 0.45, 1.4};
  advice.most_drive_ohm = 33.3;
  EXPECT_TRUE(
      describe(advice, array)
          .ends_with("Drive: the less the better. Ideal drivers: 0.9 % in the mean, at most 1.8 % for half of "
                     "the pressed taxels, 45 % for 95 %, 140 % for the worst.\n"
                     "       Up to 33.3 ohm the mean grows by less than 10 %; now the drivers have 20 ohm to 1.2 "
                     "kohm.\n"));
}

}  // namespace
}  // namespace dermis::learn::health
