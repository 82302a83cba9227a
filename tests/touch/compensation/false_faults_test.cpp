// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// What looks like a line fault and is none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/compensation/line_faults.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/healthy_arrays.hpp"
#include "support/reference_array.hpp"

namespace dermis::touch::compensation {
namespace {

using support::reference_circuit;

/// The monitor of an array whose unloaded taxels are alike, fed with readings.
class Watch {
 public:
  Watch(const ArrayDescription& array, double unloaded_siemens)
      : array_(array),
        compensator_(Compensator::create(array).value()),
        monitor_(array, std::vector<double>(array.taxel_count(), unloaded_siemens)) {
    conditioned_.sigma_ratio = 1.0 / array.readout.full_scale_counts();
  }

  /// The faults found so far, as text.
  std::string observe(const std::vector<double>& ratio) {
    conditioned_.ratio = ratio;
    conditioned_.taxels.assign(ratio.size(), TaxelStatus::ok);
    compensator_.process(conditioned_, conductance_);
    monitor_.observe(conditioned_, conductance_);
    std::string text;
    for (const LineFault& fault : monitor_.faults()) text += place_name(fault, array_) + "; ";
    return text;
  }

  [[nodiscard]] const LineFaultMonitor& monitor() const { return monitor_; }

 private:
  ArrayDescription array_;
  Compensator compensator_;
  LineFaultMonitor monitor_;
  ConditionedFrame conditioned_;
  ConductanceFrame conductance_;
};

/// Every circuit, scene and material, cut at the vendor's threshold, calibrated while something touched the array.
TEST(FalseFaults, nothing_is_masked_on_random_healthy_arrays) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const support::HealthyArray healthy = support::random_healthy_array(seed);
    EXPECT_EQ(support::found_faults(healthy, 300), "") << "seed " << seed << ": " << healthy.words;
  }
}

/// Equal pressure on a mat of equal taxels, in steps, 8 bit: all lines read alike, and nothing is wrong.
TEST(FalseFaults, uniform_loads_are_no_shorts) {
  for (const support::NamedCircuit& circuit : support::all_circuits()) {
    for (const double spread : {0.0, 0.05}) {
      support::HealthyArray healthy = support::random_healthy_array(1);
      Random random(4);
      healthy.array = support::random_array(circuit, 8, 6, random);
      healthy.array.readout.drive_ohm.assign(healthy.array.driven_lines(), 20.0);
      healthy.array.readout.load_ohm.assign(healthy.array.sensed_lines(), 1000.0);
      healthy.array.readout.adc_bits = 8;
      healthy.array.readout.adc_noise_counts = 0.5;
      healthy.array.taxel_area_m2 = 38.48e-6;
      healthy.options = {};
      healthy.options.environment.adc_noise_lsb = 0.4;
      healthy.options.rubber.resistance_spread = spread;
      healthy.options.rubber.exponent_spread = 0.0;
      healthy.scene = "uniform";
      healthy.threshold_counts = healthy.loaded_share = 0.0;
      EXPECT_EQ(support::found_faults(healthy, 120), "") << circuit << ", spread " << spread;
    }
  }
}

/// A touch that comes and goes 40 times between two lines at the edge, alike on both, and one that slides along them.
TEST(FalseFaults, the_same_press_again_and_a_long_one_are_no_short) {
  const ArrayDescription array = reference_circuit(8, 8);
  Watch watch(array, 5e-6);
  const auto press = [&](std::size_t col, double reading) {
    std::vector<double> ratio(array.taxel_count(), 1e-3);
    ratio[array.index(6, col)] = ratio[array.index(7, col)] = reading;
    ASSERT_EQ(watch.observe(ratio), "");
  };
  for (int time = 0; time < 40; ++time) {
    press(3, 0.1);
    press(3, 1e-3);
  }
  const std::vector<LineFault> suspicions = watch.monitor().suspicions();
  ASSERT_EQ(suspicions.size(), 1U);
  EXPECT_EQ(suspicions[0].kind, LineFaultKind::shorted_rows);
  EXPECT_EQ(suspicions[0].place, 6U);
  for (int step = 0; step < 400; ++step) {
    const double phase = 0.02 * step;
    press(static_cast<std::size_t>(3.5 + 3.5 * std::sin(phase)), 0.1 + 0.08 * std::sin(5.0 * phase));
  }
}

/// Columns whose taxels all read the same, at full scale too, one after the other.
TEST(FalseFaults, equal_readings_are_no_short_in_an_unknown_circuit) {
  const ArrayDescription array = reference_circuit(8, 8, Circuit::none);
  Watch watch(array, 5e-3);
  Random random(2);
  for (int frame = 0; frame < 500; ++frame) {
    std::vector<double> ratio(array.taxel_count(), 5e-3);
    const std::size_t col = random.below(array.cols);
    const double reading = frame % 2 == 0 ? 1.0 : random.uniform(0.2, 0.6);
    for (std::size_t row = 0; row < array.rows; ++row) {
      ratio[array.index(row, 5)] = 1.0;
      ratio[array.index(row, col)] = reading;
      ratio[array.index(2, row)] = ratio[array.index(3, row)] = reading;
    }
    ASSERT_EQ(watch.observe(ratio), "") << "frame " << frame;
  }
}

/// A readout that sends 0 below a threshold, calibrated while a press began.
TEST(FalseFaults, readings_cut_at_a_threshold_are_no_silence) {
  for (const Circuit circuit : {Circuit::none, Circuit::divider}) {
    const ArrayDescription array = reference_circuit(13, 6, circuit);
    Watch watch(array, circuit == Circuit::none ? 0.01 : 5e-5);
    for (int frame = 0; frame < 500; ++frame) {
      std::vector<double> ratio(array.taxel_count(), 0.0);
      const double reading = 2e-3 * std::max(frame % 100 - 40, 0);
      for (std::size_t row = 4; row < 8; ++row) {
        for (std::size_t col = 2; col < 5; ++col) ratio[array.index(row, col)] = reading;
      }
      ASSERT_EQ(watch.observe(ratio), "") << to_string(circuit) << ", frame " << frame;
    }
    EXPECT_TRUE(watch.monitor().sees_silent_column(1));
  }
}

/// An array of 16x8 taxels, column 5 of which reads half as much as the others, and what it reads unloaded.
class WeakColumn {
 public:
  static constexpr std::size_t kRows = 16;
  static constexpr std::size_t kColumn = 5;

  WeakColumn(int adc_bits, double weak_counts) : array_(reference_circuit(kRows, 8)) {
    Readout& readout = array_.readout;
    readout.adc_bits = adc_bits;
    readout.drive_ohm.assign(kRows, 0.0);
    readout.load_ohm[kColumn] = 0.5 * readout.load_ohm[0];
    const double weak = weak_counts / readout.full_scale_counts();
    siemens_ = weak / (1.0 - kRows * weak) / readout.load_ohm[kColumn];
    for (std::size_t col = 0; col < 8; ++col) {
      const double taken = siemens_ * readout.load_ohm[col];
      counts_.push_back(readout.full_scale_counts() * taken / (1.0 + kRows * taken));
    }
  }

  [[nodiscard]] Watch watch() const { return {array_, siemens_}; }

  /// The readings when `share` of the unloaded ones is left and fewer than `threshold` counts are sent as none.
  [[nodiscard]] std::vector<double> faded(double share, double threshold = 0.0) const {
    std::vector<double> ratio;
    for (std::size_t taxel = 0; taxel < array_.taxel_count(); ++taxel) {
      const double counts = std::round(share * counts_[taxel % 8]);
      ratio.push_back(counts < threshold ? 0.0 : counts / array_.readout.full_scale_counts());
    }
    return ratio;
  }

 private:
  ArrayDescription array_;
  double siemens_ = 0.0;
  std::vector<double> counts_;
};

/// Rubber that forgets, ages or warms up takes a weak column below the threshold of the readout before the others.
TEST(FalseFaults, a_line_that_fades_below_the_threshold_is_not_silent) {
  constexpr double kThreshold = 20.0;
  const WeakColumn array(16, 2.0 * kThreshold);
  Watch watch = array.watch();
  for (int frame = 0; frame < 300; ++frame) {
    const double share = std::max(1.0 - 0.02 * frame, 0.45);
    ASSERT_EQ(watch.observe(array.faded(share, kThreshold)), "") << "frame " << frame;
  }
}

/// It read five thresholds: rubber that fades would leave more than one.
TEST(FalseFaults, a_line_that_no_threshold_hides_is_silent) {
  constexpr double kThreshold = 20.0;
  const WeakColumn array(16, 5.0 * kThreshold);
  Watch watch = array.watch();
  for (int frame = 0; frame < 10; ++frame) ASSERT_EQ(watch.observe(array.faded(0.25, kThreshold)), "");
  std::vector<double> open = array.faded(1.0, kThreshold);
  for (std::size_t row = 0; row < WeakColumn::kRows; ++row) open[row * 8 + WeakColumn::kColumn] = 0.0;
  std::string found;
  for (int frame = 0; frame < 10; ++frame) found = watch.observe(open);
  EXPECT_EQ(found, "column 5; ");
}

/// An ADC that has less noise than is said rounds a weak column down to 0 in every frame, and the others up to 1.
TEST(FalseFaults, a_line_that_is_rounded_to_0_is_not_silent) {
  const WeakColumn array(8, 1.6);
  Watch watch = array.watch();
  for (int frame = 0; frame < 300; ++frame) {
    const double share = std::max(1.0 - 0.02 * frame, 0.31);
    ASSERT_EQ(watch.observe(array.faded(share)), "") << "frame " << frame;
  }
}

/// An amplifier's offset takes away as much of a faded reading as of a fresh one: a column may read 0 and work.
TEST(FalseFaults, a_line_whose_amplifier_takes_its_faded_readings_is_not_silent) {
  ArrayDescription array = reference_circuit(8, 8, Circuit::transimpedance);
  array.readout.adc_bits = 16;
  array.readout.supply_v = 5.0;
  array.readout.amplifier_offset_v.assign(8, 0.0);
  array.readout.amplifier_offset_v[5] = 3e-3;
  const double siemens = 1e-3 / array.readout.load_ohm[5];
  const auto circuit = learn::simulation::ReadoutCircuit::create(array).value();
  Watch watch(array, siemens);
  for (int frame = 0; frame < 300; ++frame) {
    const std::vector<double> faded(array.taxel_count(), std::max(1.0 - 0.01 * frame, 0.5) * siemens);
    std::vector<double> ratio(array.taxel_count());
    circuit.ratios(faded, ratio);
    for (double& reading : ratio) reading = std::max(std::round(reading * 65535.0), 0.0) / 65535.0;
    if (frame == 0) ratio[0] = 1.0 / 65535.0;  // nothing is cut off
    ASSERT_EQ(watch.observe(ratio), "") << "frame " << frame;
  }
}

/// Where all lines float, a press lifts the readings of all rows over a threshold that hides unloaded taxels, alike
/// where these are: none is supplied.
TEST(FalseFaults, a_press_that_ghosts_in_all_rows_is_no_supplied_row) {
  ArrayDescription array = reference_circuit(10, 8);
  array.readout.idle_rows = IdleRows::floating;
  array.readout.idle_columns = IdleColumns::floating;
  array.readout.load_ohm.assign(8, 8000.0);
  constexpr double kThreshold = 85.0;
  const double siemens = 5e-7;
  const auto circuit = learn::simulation::ReadoutCircuit::create(array).value();
  Watch watch(array, 0.0);
  std::vector<double> ratio(array.taxel_count());
  for (std::size_t press = 0; press < 60; ++press) {
    for (const bool is_pressed : {true, false}) {
      std::vector<double> pressed(array.taxel_count(), siemens);
      if (is_pressed) pressed[array.index(1 + press % 8, 3 * press % 8)] = 2e-3;
      circuit.ratios(pressed, ratio);
      for (double& reading : ratio) {
        const double counts = std::round(reading * 4095.0);
        reading = counts < kThreshold ? 0.0 : counts / 4095.0;
      }
      ASSERT_EQ(watch.observe(ratio), "") << "press " << press;
    }
  }
}

}  // namespace
}  // namespace dermis::touch::compensation
