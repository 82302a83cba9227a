// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/examination.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/line_faults.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::uint64_t kSeed = 3;

/// An array of 8 x 8 taxels that is measured a hundred times a second, and what is out of order about it.
struct Measurement {
  touch::pipeline::Model model = support::hand_made_model(8, 8);
  simulation::LineFaults faults;
  double noise_lsb = 1.0;
  double unloaded_share = 1.0;  ///< Of the conductance that was calibrated.
  double celsius = 25.0;
  std::vector<double> newtons = std::vector<double>(64);
  std::size_t frames = 200;

  Measurement() {
    model.array.readout.adc_bits = 16;
    model.array.readout.load_ohm.assign(8, 2000.0);
  }

  [[nodiscard]] RawFrame frame(std::size_t number) const {
    std::vector<double> siemens(newtons.size());
    for (std::size_t k = 0; k < siemens.size(); ++k) {
      siemens[k] = support::siemens_under(model, k, newtons[k], celsius) * (newtons[k] > 0.0 ? 1.0 : unloaded_share);
    }
    std::vector<double> ratio(siemens.size());
    simulation::FaultyCircuit::create(model.array, faults)->ratios(siemens, number, ratio);
    RawFrame raw;
    raw.time = number * std::chrono::milliseconds(10);
    raw.temperature_celsius = celsius;
    raw.supply_v = 5.0;
    raw.counts.resize(siemens.size());
    Random random(kSeed + number);
    simulation::Adc(model.array.readout, noise_lsb).convert(ratio, 5.0, random, raw.counts);
    return raw;
  }
};

/// A pipeline and its examination, frame by frame.
class Examined {
 public:
  explicit Examined(const touch::pipeline::Model& model)
      : pipeline_(touch::pipeline::Pipeline::create(model).value()), examination_(model) {}

  void add(const RawFrame& raw) {
    pipeline_.process(raw, force_);
    examination_.add(raw, force_, pipeline_);
  }
  [[nodiscard]] Diagnosis diagnosis() const { return examination_.diagnosis(pipeline_); }

 private:
  touch::pipeline::Pipeline pipeline_;
  Examination examination_;
  ForceFrame force_;
};

Diagnosis examine(const Measurement& measurement) {
  Examined examined(measurement.model);
  for (std::size_t number = 0; number < measurement.frames; ++number) examined.add(measurement.frame(number));
  return examined.diagnosis();
}

bool says(const Diagnosis& diagnosis, const std::string& words) {
  for (const std::string& finding : diagnosis.findings) {
    if (finding.find(words) != std::string::npos) return true;
  }
  return false;
}

/// Touches of a sheet whose taxels read their gains times the force, broad ones in all places.
Diagnosis examine_touches(double gain_spread, double row_spread = 0.0) {
  Measurement measurement;
  Random random(kSeed);
  std::vector<double> gains;
  for (int k = 0; k < 64; ++k) gains.push_back(std::exp(gain_spread * random.normal()));
  for (std::size_t row = 0; row < 8; ++row) {
    const double gain = std::exp(row_spread * random.normal());
    for (std::size_t col = 0; col < 8; ++col) gains[row * 8 + col] *= gain;
  }
  Examined examined(measurement.model);
  for (std::size_t touch = 0; touch < 50; ++touch) {
    const double row = random.uniform(0.0, 7.0);
    const double col = random.uniform(0.0, 7.0);
    for (std::size_t k = 0; k < 64; ++k) {
      const std::size_t line = k / 8;
      const double square =
          std::pow(static_cast<double>(line) - row, 2) + std::pow(static_cast<double>(k % 8) - col, 2);
      measurement.newtons[k] = 10.0 * std::exp(-square / 4.0) * gains[k];
    }
    for (std::size_t k = 0; k < 5; ++k) examined.add(measurement.frame(10 * touch + k));
    measurement.newtons.assign(64, 0.0);
    for (std::size_t k = 5; k < 10; ++k) examined.add(measurement.frame(10 * touch + k));
  }
  return examined.diagnosis();
}

TEST(Examination, gains_that_have_changed_are_found_by_touches) {
  const Diagnosis aged = examine_touches(0.2);
  EXPECT_TRUE(says(aged, "recalibrate: gains have changed by about "));
  EXPECT_NEAR(*aged.ageing.gain_spread, 0.2, 0.06);
  const Diagnosis fresh = examine_touches(0.0);
  EXPECT_TRUE(fresh.is_healthy()) << fresh.findings.front();
  EXPECT_LT(*fresh.ageing.gain_spread, 0.02);
}

TEST(Examination, gains_of_rows_are_found_by_touches) {
  const Diagnosis aged = examine_touches(0.0, 0.15);
  EXPECT_TRUE(says(aged, " from row to row"));
  EXPECT_FALSE(says(aged, " from column to column"));
}

TEST(Examination, what_raw_counts_alone_say_is_a_finding) {
  Measurement measurement;
  Examined examined(measurement.model);
  for (std::size_t number = 0; number < 256; ++number) {
    measurement.newtons.assign(64, 0.0);
    if (number % 4 != 0) measurement.newtons[number / 4] = 10.0;
    RawFrame raw = measurement.frame(number);
    for (std::size_t k = 1; k < 64; k += 2) raw.counts[k] = raw.counts[k - 1];
    examined.add(raw);
  }
  EXPECT_TRUE(says(examined.diagnosis(), "columns 0 and 1, 2 and 3, 4 and 5, ... read the same"));
}

TEST(Examination, what_the_calibration_doubted_is_a_finding) {
  Measurement measurement;
  measurement.model.provenance[touch::pipeline::kDoubts] = "drive_ohm is not as given";
  EXPECT_TRUE(says(examine(measurement), "since the calibration: drive_ohm is not as given"));
}

TEST(Examination, an_array_as_it_was_calibrated_is_healthy) {
  const Diagnosis diagnosis = examine(Measurement());
  EXPECT_TRUE(diagnosis.is_healthy()) << diagnosis.findings.front();
  EXPECT_EQ(diagnosis.frames, 200U);
  EXPECT_EQ(diagnosis.frames_rejected, 0U);
  EXPECT_EQ(diagnosis.frames_unsolved, 0U);
  EXPECT_NEAR(diagnosis.seconds, 1.99, 1e-9);
  ASSERT_TRUE(diagnosis.noise_counts);
  EXPECT_NEAR(*diagnosis.noise_counts, 1.04, 0.1);  // with the rounding of the ADC
  ASSERT_TRUE(diagnosis.offset_drift);
  EXPECT_NEAR(*diagnosis.offset_drift, 0.0, 0.02);
  ASSERT_TRUE(diagnosis.temperature);
  EXPECT_EQ(diagnosis.temperature->coldest_celsius, 25.0);
  EXPECT_EQ(diagnosis.temperature->hottest_celsius, 25.0);
  EXPECT_TRUE(diagnosis.blind_lines.empty());
}

TEST(Examination, an_open_row_is_found_with_its_place_and_its_first_frame) {
  Measurement measurement;
  measurement.faults.rows.open = {2};
  measurement.faults.from_frame = 50;
  const Diagnosis diagnosis = examine(measurement);
  ASSERT_EQ(diagnosis.faults.size(), 1U);
  EXPECT_EQ(diagnosis.faults[0].fault.kind, touch::compensation::LineFaultKind::silent_row);
  EXPECT_EQ(diagnosis.faults[0].fault.place, 2U);
  EXPECT_EQ(diagnosis.faults[0].fault.frame, 50U);
  EXPECT_FALSE(diagnosis.faults[0].until);
  ASSERT_EQ(diagnosis.findings.size(), 1U);
  EXPECT_EQ(diagnosis.findings[0], "row 2 " + describe(diagnosis.faults[0], measurement.model.array));
}

TEST(Examination, a_fault_that_goes_has_an_end) {
  Measurement measurement;
  measurement.faults.columns.open = {5};
  measurement.faults.from_frame = 50;
  measurement.faults.until_frame = 100;
  const Diagnosis diagnosis = examine(measurement);
  ASSERT_EQ(diagnosis.faults.size(), 1U);
  ASSERT_TRUE(diagnosis.faults[0].until);
  EXPECT_GE(*diagnosis.faults[0].until, 100U);
  EXPECT_LE(*diagnosis.faults[0].until, 120U);
  EXPECT_TRUE(says(diagnosis, "loose contact"));
}

TEST(Examination, noise_that_has_grown_is_found_and_contacts_are_no_noise) {
  Measurement measurement;
  measurement.newtons[27] = 20.0;
  EXPECT_TRUE(examine(measurement).is_healthy());
  measurement.noise_lsb = 4.0;
  const Diagnosis diagnosis = examine(measurement);
  EXPECT_NEAR(diagnosis.noise_counts.value_or(0.0), 4.0, 0.4);
  EXPECT_TRUE(says(diagnosis, "the readings have 4.0 counts of noise or hum, 4.0 times what was calibrated"));
}

TEST(Examination, noise_is_not_known_where_everything_is_touched) {
  Measurement measurement;
  measurement.newtons.assign(64, 5.0);
  const Diagnosis diagnosis = examine(measurement);
  EXPECT_FALSE(diagnosis.noise_counts);
  EXPECT_FALSE(diagnosis.offset_drift);
}

TEST(Examination, an_unloaded_sheet_that_conducts_a_fifth_more_was_put_on_anew) {
  Measurement measurement;
  measurement.unloaded_share = 1.2;
  EXPECT_TRUE(says(examine(measurement), "unloaded taxels conduct +20 % against the calibration"));
  measurement.unloaded_share = 1.08;
  EXPECT_TRUE(examine(measurement).is_healthy());
}

/// The untouched sheet; `change` alters the readings of some frames.
template <typename Change>
Diagnosis examine_untouched(const Change& change) {
  Measurement measurement;
  Examined examined(measurement.model);
  for (std::size_t number = 0; number < 400; ++number) {
    RawFrame raw = measurement.frame(number);
    if (number % 20 < 3) {
      for (float& count : raw.counts) count = change(count, number);
    }
    examined.add(raw);
  }
  return examined.diagnosis();
}

TEST(Examination, a_supply_that_falls_for_moments_is_found_and_noise_of_all_readings_is_no_supply) {
  EXPECT_TRUE(examine_untouched([](float count, std::size_t) { return count; }).is_healthy());
  const Diagnosis loose = examine_untouched([](float count, std::size_t) { return std::round(0.92F * count); });
  EXPECT_TRUE(says(loose, "the supply falls by about ")) << testing::PrintToString(loose.findings);
  const Diagnosis hum = examine_untouched(
      [](float count, std::size_t number) { return std::max(count + (number % 2 == 0 ? 20.0F : -20.0F), 0.0F); });
  EXPECT_FALSE(says(hum, "the supply falls"));
}

TEST(Examination, unloaded_taxels_that_have_moved_ask_for_a_calibration) {
  Measurement measurement;
  measurement.unloaded_share = 1.5;
  const Diagnosis diagnosis = examine(measurement);
  EXPECT_NEAR(diagnosis.offset_drift.value_or(0.0), 0.5, 0.05);
  EXPECT_TRUE(says(diagnosis, "unloaded taxels conduct +50 % against the calibration: tare"));
}

TEST(Examination, a_temperature_beyond_the_calibration_is_found_with_a_margin_of_one_degree) {
  Measurement measurement;
  measurement.celsius = 45.9;
  EXPECT_FALSE(says(examine(measurement), "the temperature leaves the calibrated range"));
  measurement.celsius = 46.1;
  EXPECT_TRUE(says(examine(measurement), "the temperature leaves the calibrated range"));
}

TEST(Examination, a_supply_outside_of_the_calibration_is_found) {
  Measurement measurement;
  measurement.model.array.readout.adc_reference_v = 5.0;
  measurement.model.array.readout.supply_v = 6.0;
  measurement.model.supply = touch::preprocessing::SupplyRange{4.9, 6.1};
  const Diagnosis inside = examine(measurement);
  EXPECT_EQ(inside.supply, (touch::preprocessing::SupplyRange{5.0, 5.0}));
  EXPECT_FALSE(says(inside, "the supply leaves the calibrated range"));
  measurement.model.supply = touch::preprocessing::SupplyRange{5.9, 6.1};
  EXPECT_TRUE(says(examine(measurement), "the supply leaves the calibrated range"));
  measurement.model.array.readout.adc_reference_v.reset();
  EXPECT_FALSE(examine(measurement).supply) << "it has no part in the forces";
}

TEST(Examination, readings_at_the_end_of_the_adc_are_counted) {
  Measurement measurement;
  measurement.model.array.readout.adc_reference_v = 1.0;
  measurement.model.array.readout.supply_v = 5.0;
  measurement.newtons[9] = 40.0;
  const Diagnosis diagnosis = examine(measurement);
  EXPECT_DOUBLE_EQ(diagnosis.saturated_share, 1.0 / 64.0);
  EXPECT_TRUE(says(diagnosis, "1.6 % of the readings stand at the end of the ADC"));
}

TEST(Examination, a_taxel_without_a_reading_is_named) {
  const Measurement measurement;
  Examined examined(measurement.model);
  for (std::size_t frame = 0; frame < 10; ++frame) {
    RawFrame raw = measurement.frame(frame);
    if (frame < 7) raw.counts[5] = std::numeric_limits<float>::quiet_NaN();
    examined.add(raw);
  }
  const Diagnosis diagnosis = examined.diagnosis();
  EXPECT_EQ(diagnosis.frames_rejected, 0U);
  EXPECT_TRUE(says(diagnosis, "no reading (not a number, or outside the ADC) of r0c5 in 7 of 10 frames"));
}

/// Frames of an array of which these readings stand at the end of the ADC.
Diagnosis examine_saturated(const std::vector<std::size_t>& taxels) {
  const Measurement measurement;
  Examined examined(measurement.model);
  for (std::size_t frame = 0; frame < 100; ++frame) {
    RawFrame raw = measurement.frame(frame);
    for (const std::size_t taxel : taxels) raw.counts[taxel] = 65535.0F;
    examined.add(raw);
  }
  return examined.diagnosis();
}

std::size_t findings_with(const Diagnosis& diagnosis, const std::string& words) {
  return static_cast<std::size_t>(
      std::count_if(diagnosis.findings.begin(), diagnosis.findings.end(),
                    [&](const std::string& finding) { return finding.find(words) != std::string::npos; }));
}

TEST(Examination, a_reading_that_the_circuit_cannot_give_is_named) {
  const Diagnosis diagnosis = examine_saturated({3 * 8 + 4});
  EXPECT_EQ(diagnosis.frames_unsolved, 0U);
  EXPECT_EQ(findings_with(diagnosis, "r3c4 reads more than the circuit can give"), 1U);
}

TEST(Examination, a_saturated_line_and_a_saturated_array_are_one_finding_each) {
  std::vector<std::size_t> row;
  for (std::size_t taxel = 24; taxel < 32; ++taxel) row.push_back(taxel);  // row 3 of 8
  const Diagnosis of_row = examine_saturated(row);
  EXPECT_EQ(findings_with(of_row, "row 3 has no force in any of 100 frames"), 1U);
  EXPECT_EQ(findings_with(of_row, "taxel"), 0U);
  std::vector<std::size_t> all(64);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Diagnosis of_all = examine_saturated(all);
  EXPECT_FALSE(of_all.is_healthy());
  EXPECT_LE(of_all.findings.size(), 3U);
}

TEST(Examination, rejected_frames_are_counted_by_their_reason) {
  const Measurement measurement;
  Examined examined(measurement.model);
  RawFrame raw = measurement.frame(0);
  raw.counts[5] = std::numeric_limits<float>::quiet_NaN();
  raw.counts.resize(63);
  examined.add(raw);
  const Diagnosis none = examined.diagnosis();
  EXPECT_EQ(none.frames_rejected, 1U);
  EXPECT_EQ(none.seconds, 0.0);
  EXPECT_FALSE(none.temperature);
  EXPECT_TRUE(says(none, "no frame could be used"));
  examined.add(measurement.frame(1));
  const Diagnosis diagnosis = examined.diagnosis();
  EXPECT_EQ(diagnosis.frames, 2U);
  ASSERT_EQ(diagnosis.rejections.size(), 1U);
  EXPECT_EQ(diagnosis.rejections.begin()->second, 1U);
  EXPECT_TRUE(says(diagnosis, "1 frames rejected: " + diagnosis.rejections.begin()->first));
  EXPECT_FALSE(says(diagnosis, "no frame could be used"));
}

TEST(Examination, lines_that_read_too_little_unloaded_are_blind) {
  Measurement measurement;
  measurement.model.array.readout.adc_bits = 8;
  measurement.model.array.readout.load_ohm.assign(8, 20.0);
  measurement.frames = 20;
  const Diagnosis diagnosis = examine(measurement);
  EXPECT_EQ(diagnosis.blind_lines.size(), 16U);
  EXPECT_EQ(diagnosis.blind_lines.front(), "row 0");
  EXPECT_EQ(diagnosis.blind_lines.back(), "column 7");
}

}  // namespace
}  // namespace dermis::learn::health
