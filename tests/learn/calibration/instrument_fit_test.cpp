// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// In what an instrument is not as its description says, found by a calibration.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/learn/simulation/sampling_capacitor.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "support/reference_array.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLines = 6;
constexpr std::size_t kTaxels = kLines * kLines;

/// 30 ohm, 220 ohm, 12 bits.
ArrayDescription described() {
  ArrayDescription array = support::reference_circuit(kLines, kLines, Circuit::divider);
  array.readout.drive_ohm.assign(kLines, 30.0);
  array.readout.load_ohm.assign(kLines, 220.0);
  array.readout.adc_bits = 12;
  array.readout.adc_reference_v = 5.0;
  array.readout.supply_v = 5.0;
  return array;
}

/// Frames of an instrument as it is, and their labels.
struct Rig {
  explicit Rig(const ArrayDescription& truth, std::uint64_t seed)
      : random(seed), circuit(*simulation::ReadoutCircuit::create(truth)), capacitor(truth), adc(truth.readout, 0.7) {
    for (double& ohm : ten_newton_ohm) ohm = 900.0 * std::exp(0.15 * random.normal());
    for (double& exponent : exponents) exponent = 0.9 + 0.03 * random.normal();
  }

  void press(const std::vector<std::size_t>& taxels, double newtons) {
    std::vector<double> siemens(kTaxels, 1.0 / 300e3);
    for (const std::size_t taxel : taxels) {
      const double ohm = 60.0 + ten_newton_ohm[taxel] * std::pow(10.0 / newtons, exponents[taxel]);
      siemens[taxel] += std::exp(0.005 * random.normal()) / ohm;
      loads.push_back({frames.size(), LoadKind::force, region_of(taxel), newtons});
    }
    if (taxels.empty()) loads.push_back({frames.size(), LoadKind::force, {0, 0, kLines - 1, kLines - 1}, 0.0});
    RawFrame frame;
    frame.time = std::chrono::milliseconds(10 * frames.size());
    frame.counts.resize(kTaxels);
    std::vector<double> ratio(kTaxels);
    circuit.ratios(siemens, ratio);
    capacitor.sample(ratio, 5.0);
    adc.convert(ratio, 5.0, random, frame.counts);
    frames.push_back(std::move(frame));
  }

  static TaxelRegion region_of(std::size_t taxel) {
    return {taxel / kLines, taxel % kLines, taxel / kLines, taxel % kLines};
  }

  Random random;
  simulation::ReadoutCircuit circuit;
  simulation::SamplingCapacitor capacitor;
  simulation::Adc adc;
  std::vector<double> ten_newton_ohm = std::vector<double>(kTaxels);
  std::vector<double> exponents = std::vector<double>(kTaxels);
  std::vector<RawFrame> frames;
  std::vector<Load> loads;
};

/// Each taxel alone under six weights, and pairs in each row.
Rig presses_of(const ArrayDescription& truth, std::uint64_t seed) {
  Rig rig(truth, seed);
  for (int k = 0; k < 20; ++k) rig.press({}, 0.0);
  for (std::size_t taxel = 0; taxel < kTaxels; ++taxel) {
    for (const double newtons : {0.7, 1.5, 3.0, 6.0, 12.0, 20.0}) rig.press({taxel}, newtons);
  }
  for (std::size_t row = 0; row < kLines; ++row) {
    for (int k = 0; k < 8; ++k) {
      const std::size_t col = rig.random.below(kLines - 1);
      rig.press({row * kLines + col, row * kLines + col + 1}, k % 2 == 0 ? 20.0 : 8.0);
    }
  }
  return rig;
}

SampleDatabase calibrated(const ArrayDescription& truth, const ArrayDescription& array, std::uint64_t seed = 1) {
  const Rig rig = presses_of(truth, seed);
  Result<SampleDatabase> database = build_sample_database(array, rig.frames, rig.loads);
  EXPECT_TRUE(database) << (database ? "" : database.error().message);
  return database ? *std::move(database) : SampleDatabase{};
}

bool contains(const std::vector<std::string>& sentences, const std::string& words) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& sentence) { return sentence.find(words) != std::string::npos; });
}

bool says(const SampleDatabase& database, const std::string& words) {
  return contains(database.remarks, words);
}

bool doubts(const SampleDatabase& database, const std::string& words) {
  return contains(database.doubts, words);
}

TEST(InstrumentFit, an_instrument_as_described_is_left_alone) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const SampleDatabase database = calibrated(described(), described(), seed);
    EXPECT_TRUE(database.remarks.empty()) << database.remarks.front();
    EXPECT_FALSE(database.array.readout.adc_errors.any());
    EXPECT_FALSE(database.array.readout.supply_ohm);
    EXPECT_EQ(database.unexplained_share, 0.0);
  }
}

TEST(InstrumentFit, readings_that_keep_some_of_the_one_before_are_found_and_undone) {
  ArrayDescription truth = described();
  truth.readout.adc_errors.settling = 0.03;
  const SampleDatabase database = calibrated(truth, described());
  ASSERT_TRUE(database.array.readout.adc_errors.settling);
  EXPECT_NEAR(*database.array.readout.adc_errors.settling, 0.03, 0.002);
  EXPECT_TRUE(says(database, "has not settled"));
}

TEST(InstrumentFit, an_offset_of_the_adc_is_found_and_undone) {
  ArrayDescription truth = described();
  truth.readout.adc_errors.offset_counts = 10.0;
  const SampleDatabase database = calibrated(truth, described());
  ASSERT_TRUE(database.array.readout.adc_errors.offset_counts);
  EXPECT_NEAR(*database.array.readout.adc_errors.offset_counts, 10.0, 1.0);
  EXPECT_TRUE(says(database, "counts too much"));
}

TEST(InstrumentFit, a_supply_that_sags_is_found_and_undone) {
  ArrayDescription truth = described();
  truth.readout.supply_ohm = 12.0;
  const SampleDatabase database = calibrated(truth, described());
  ASSERT_TRUE(database.array.readout.supply_ohm);
  EXPECT_NEAR(*database.array.readout.supply_ohm, 12.0, 2.0);
  EXPECT_TRUE(says(database, "the supply sags"));
}

TEST(InstrumentFit, drivers_that_are_not_as_given_are_named_and_doubted_but_not_changed) {
  ArrayDescription truth = described();
  truth.readout.drive_ohm = {70.0, 150.0, 90.0, 130.0, 75.0, 145.0};
  const SampleDatabase database = calibrated(truth, described());
  EXPECT_EQ(database.array.readout.drive_ohm, described().readout.drive_ohm);
  EXPECT_TRUE(doubts(database, "drive_ohm is not as given"));
  EXPECT_GT(database.unexplained_share, 0.03);
}

TEST(InstrumentFit, pairs_tell_by_how_much_touches_of_whole_rows_are_off) {
  ArrayDescription truth = described();
  truth.readout.drive_ohm = {70.0, 150.0, 90.0, 130.0, 75.0, 145.0};
  for (const std::uint64_t seed : {1U, 2U}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Rig rig = presses_of(truth, seed);
    const auto calibration = calibrate(described(), rig.frames, rig.loads);
    ASSERT_TRUE(calibration);
    const std::size_t labelled = rig.frames.size();
    for (std::size_t row = 0; row < kLines; ++row) {
      std::vector<std::size_t> taxels(kLines);
      std::iota(taxels.begin(), taxels.end(), row * kLines);
      rig.press(taxels, 10.0);
    }
    auto pipeline = touch::pipeline::Pipeline::create(calibration->model);
    ForceFrame force;
    std::vector<double> errors;
    for (std::size_t row = 0; row < kLines; ++row) {
      pipeline->process(rig.frames[labelled + row], force);
      for (std::size_t col = 0; col < kLines; ++col) {
        errors.push_back(std::abs(static_cast<double>(force.newtons[row * kLines + col]) / 10.0 - 1.0));
      }
    }
    EXPECT_GT(calibration->report.uncertainty.unexplained_share, quantile(errors, 0.5));
  }
}

TEST(InstrumentFit, a_dead_zone_of_the_adc_is_named_with_the_force_from_which_it_reads) {
  ArrayDescription truth = described();
  truth.readout.adc_errors.offset_counts = -200.0;  // no reading below
  const SampleDatabase database = calibrated(truth, described());
  EXPECT_TRUE(doubts(database, "below 3 N the readings tell nothing"));
}

TEST(InstrumentFit, what_is_told_is_not_fitted_again) {
  ArrayDescription truth = described();
  truth.readout.adc_errors.settling = 0.03;
  truth.readout.adc_errors.offset_counts = 10.0;
  truth.readout.supply_ohm = 12.0;
  const SampleDatabase database = calibrated(truth, truth);
  EXPECT_TRUE(database.remarks.empty()) << database.remarks.front();
  EXPECT_EQ(database.array.readout.adc_errors.settling, 0.03);
  EXPECT_EQ(database.array.readout.adc_errors.offset_counts, 10.0);
  EXPECT_EQ(database.array.readout.supply_ohm, 12.0);
}

TEST(InstrumentFit, what_is_asked_for_becomes_a_number_or_is_said_to_be_untold) {
  ArrayDescription array = described();
  array.readout.adc_errors.settling = kFit;
  array.readout.supply_ohm = kFit;
  const SampleDatabase database = calibrated(described(), array);
  EXPECT_FALSE(database.array.has_unknown_circuit());
  EXPECT_TRUE(says(database, "readings settle"));
}

}  // namespace
}  // namespace dermis::learn::calibration
