// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/compensation/crosstalk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/inversion_campaign.hpp"
#include "support/nodal_array.hpp"
#include "support/reference_array.hpp"

namespace dermis::touch::compensation {
namespace {

ArrayDescription make_array(std::size_t rows, std::size_t cols, Circuit circuit = Circuit::divider) {
  ArrayDescription array = support::reference_circuit(rows, cols, circuit);
  array.readout.adc_bits = 24;
  return array;
}

ArrayDescription make_array(std::size_t rows, std::size_t cols, Circuit circuit, double drive_ohm, double load_ohm) {
  ArrayDescription array = make_array(rows, cols, circuit);
  array.readout.drive_ohm.assign(rows, drive_ohm);
  array.readout.load_ohm.assign(cols, load_ohm);
  return array;
}

void scatter_resistors(ArrayDescription& array, Random& random) {
  for (double& ohm : array.readout.drive_ohm) ohm = random.below(4) == 0 ? 0.0 : random.uniform(2.0, 100.0);
  for (double& ohm : array.readout.load_ohm) ohm = random.log_uniform(100.0, 5e3);
}

std::vector<double> random_siemens(const ArrayDescription& array, Random& random) {
  std::vector<double> siemens(array.taxel_count());
  for (double& value : siemens) value = 1.0 / random.log_uniform(200.0, 1e6);
  return siemens;
}

std::unique_ptr<CrosstalkInversion> inversion_for(const ArrayDescription& array) {
  EXPECT_TRUE(array.validate());
  auto inversion = make_crosstalk_inversion(array);
  return inversion ? std::move(*inversion) : nullptr;
}

struct Inverted {
  bool solved = false;
  std::vector<double> siemens;
};

Inverted invert(const ArrayDescription& array, const std::vector<double>& ratio) {
  Inverted inverted;
  inverted.siemens.resize(ratio.size());
  inverted.solved = inversion_for(array)->invert(ratio, inverted.siemens).solved;
  return inverted;
}

std::vector<double> loaded_columns(const ArrayDescription& array, const std::vector<double>& siemens) {
  std::vector<double> columns;
  for (std::size_t j = 0; j < array.cols; ++j) {
    columns.push_back(1.0 / array.readout.load_ohm[j]);
    for (std::size_t i = 0; i < array.rows; ++i) columns[j] += siemens[array.index(i, j)];
  }
  return columns;
}

/// The solver stops once a step changes no taxel by more than 0.01 count of the ADC, relative to its column (load and
/// all taxels together). With the 24 bit of make_array() what is left is at most 1e-8 of the column, and 1e-6 of a
/// taxel of 10 kohm or less.
constexpr double kColumnTolerance = 1e-8;
constexpr double kPressedTolerance = 1e-6;
constexpr double kPressedSiemens = 1e-4;

void expect_same(const ArrayDescription& array, const Inverted& inverted, const std::vector<double>& siemens) {
  ASSERT_TRUE(inverted.solved);
  const auto columns = loaded_columns(array, siemens);
  for (std::size_t k = 0; k < siemens.size(); ++k) {
    ASSERT_NEAR(inverted.siemens[k], siemens[k], kColumnTolerance * columns[k % array.cols]) << "taxel " << k;
    if (siemens[k] >= kPressedSiemens) {
      ASSERT_NEAR(inverted.siemens[k] / siemens[k], 1.0, kPressedTolerance) << "taxel " << k;
    }
  }
}

struct Size {
  std::size_t rows;
  std::size_t cols;
};

std::ostream& operator<<(std::ostream& out, const Size& size) {
  return out << size.rows << 'x' << size.cols;
}

class DividerOfSize : public testing::TestWithParam<Size> {};

TEST_P(DividerOfSize, conductances_come_back_for_every_driver_and_load) {
  for (const double drive_ohm : {0.0, 5.0, 20.0, 100.0}) {
    for (const double load_ohm : {100.0, 200.0, 1000.0, 5000.0}) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(testing::Message() << "drive " << drive_ohm << ", load " << load_ohm << ", seed " << seed);
        Random random(seed);
        const auto array = make_array(GetParam().rows, GetParam().cols, Circuit::divider, drive_ohm, load_ohm);
        const auto siemens = random_siemens(array, random);
        expect_same(array, invert(array, support::divider_ratios(array, siemens)), siemens);
      }
    }
  }
}

TEST_P(DividerOfSize, conductances_come_back_for_resistors_of_each_line) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    auto array = make_array(GetParam().rows, GetParam().cols);
    scatter_resistors(array, random);
    const auto siemens = random_siemens(array, random);
    expect_same(array, invert(array, support::divider_ratios(array, siemens)), siemens);
  }
}

TEST_P(DividerOfSize, what_the_solver_leaves_is_a_small_part_of_a_count) {
  for (const int bits : {8, 12, 16}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      SCOPED_TRACE(testing::Message() << bits << " bit, seed " << seed);
      Random random(seed);
      auto array = make_array(GetParam().rows, GetParam().cols);
      array.readout.adc_bits = bits;
      scatter_resistors(array, random);
      const auto siemens = random_siemens(array, random);
      const auto inverted = invert(array, support::divider_ratios(array, siemens));
      ASSERT_TRUE(inverted.solved);
      const auto columns = loaded_columns(array, siemens);
      const double count = 1.0 / array.readout.full_scale_counts();
      for (std::size_t k = 0; k < siemens.size(); ++k) {
        ASSERT_NEAR(inverted.siemens[k], siemens[k], 0.2 * count * columns[k % array.cols]) << "taxel " << k;
      }
    }
  }
}

TEST_P(DividerOfSize, ideal_drivers_are_solved_to_rounding) {
  Random random(5);
  const auto array = make_array(GetParam().rows, GetParam().cols, Circuit::divider, 0.0, 1000.0);
  const auto siemens = random_siemens(array, random);
  const auto inverted = invert(array, support::divider_ratios(array, siemens));
  ASSERT_TRUE(inverted.solved);
  for (std::size_t k = 0; k < siemens.size(); ++k) EXPECT_NEAR(inverted.siemens[k] / siemens[k], 1.0, 1e-11);
}

TEST_P(DividerOfSize, contacts_come_back_from_an_array_that_is_open_elsewhere) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const auto array = make_array(GetParam().rows, GetParam().cols);
    std::vector<double> siemens(array.taxel_count(), 0.0);
    for (int k = 0; k < 4; ++k) siemens[random.below(siemens.size())] = 1.0 / random.log_uniform(200.0, 5e3);
    expect_same(array, invert(array, support::divider_ratios(array, siemens)), siemens);
  }
}

TEST_P(DividerOfSize, transimpedance_comes_back_to_rounding) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    auto array = make_array(GetParam().rows, GetParam().cols, Circuit::transimpedance);
    scatter_resistors(array, random);
    array.readout.idle_rows = seed % 2 == 0 ? IdleRows::grounded : IdleRows::floating;
    const auto siemens = random_siemens(array, random);
    const auto inverted = invert(array, support::transimpedance_ratios(array, siemens));
    ASSERT_TRUE(inverted.solved);
    for (std::size_t k = 0; k < siemens.size(); ++k) EXPECT_NEAR(inverted.siemens[k] / siemens[k], 1.0, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(CrosstalkInversion, DividerOfSize,
                         testing::Values(Size{1, 1}, Size{2, 3}, Size{8, 8}, Size{16, 16}, Size{12, 10}, Size{32, 32},
                                         Size{1, 9}, Size{9, 1}),
                         testing::PrintToStringParamName());

TEST(CrosstalkInversion, one_taxel_is_the_divider_formula) {
  // T = RL / (Rd + 1/G + RL), so G = T / (RL (1 - T) - Rd T); below 0 there is no conductance.
  const auto array = make_array(1, 1);
  for (const double ratio : {-0.01, -1e-4, 0.0, 1e-3, 0.1, 0.5, 0.8}) {
    const auto inverted = invert(array, {ratio});
    EXPECT_TRUE(inverted.solved);
    const double expected = std::max(ratio, 0.0) / (200.0 * (1.0 - ratio) - 20.0 * ratio);
    EXPECT_NEAR(inverted.siemens[0], expected, 1e-6 * std::max(std::abs(ratio), 5e-3)) << ratio;
  }
}

TEST(CrosstalkInversion, unloaded_array_reads_zero) {
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance, Circuit::none}) {
    const auto inverted = invert(make_array(4, 5, circuit), std::vector<double>(20, 0.0));
    EXPECT_TRUE(inverted.solved);
    for (const double siemens : inverted.siemens) EXPECT_EQ(siemens, 0.0);
  }
}

TEST(CrosstalkInversion, noise_of_unloaded_taxels_stays_small_and_not_negative) {
  // Half of the readings lie below what the neighbours explain: 0 S. The others have the noise of a reading.
  constexpr std::uint64_t kSeed = 21;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  constexpr double kNoise = 1.0 / 4095.0;
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    Random random(kSeed);
    const auto array = make_array(8, 8, circuit);
    std::vector<double> siemens(64, 0.0);
    siemens[array.index(2, 3)] = 1e-3;
    siemens[array.index(5, 6)] = 2e-3;
    const auto clean = circuit == Circuit::divider ? support::divider_ratios(array, siemens)
                                                   : support::transimpedance_ratios(array, siemens);
    const auto inversion = inversion_for(array);
    std::vector<double> inverted(64);
    double square = 0.0;
    int held = 0;
    int count = 0;
    for (int frame = 0; frame < 200; ++frame) {
      std::vector<double> noisy = clean;
      for (double& ratio : noisy) ratio += kNoise * random.normal();
      ASSERT_TRUE(inversion->invert(noisy, inverted).solved);
      for (std::size_t k = 0; k < 64; ++k) {
        ASSERT_GE(inverted[k], 0.0);
        if (siemens[k] > 0.0) continue;
        square += inverted[k] * inverted[k];
        held += inverted[k] == 0.0 ? 1 : 0;
        ++count;
      }
    }
    EXPECT_NEAR(std::sqrt(2.0 * square / count), kNoise / 200.0, 0.3 * kNoise / 200.0);
    EXPECT_NEAR(static_cast<double>(held) / count, 0.5, 0.05);
  }
}

TEST(CrosstalkInversion, unknown_circuit_passes_positive_readings_on) {
  auto array = make_array(2, 2, Circuit::none);
  array.readout.drive_ohm.clear();
  array.readout.load_ohm.clear();
  const std::vector<double> ratio = {0.0, -0.25, 0.5, 1.0};
  const auto inverted = invert(array, ratio);
  EXPECT_TRUE(inverted.solved);
  EXPECT_EQ(inverted.siemens, (std::vector<double>{0.0, 0.0, 0.5, 1.0}));
  EXPECT_FALSE(invert(array, {0.0, std::numeric_limits<double>::infinity(), 0.5, 1.0}).solved);
}

TEST(CrosstalkInversion, a_frame_does_not_depend_on_what_was_forgotten_and_hardly_on_the_one_before) {
  constexpr std::uint64_t kSeed = 22;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    Random random(kSeed);
    const auto array = make_array(8, 8, circuit, 100.0, 5000.0);
    const auto ratios_of = [&](const std::vector<double>& siemens) {
      return circuit == Circuit::divider ? support::divider_ratios(array, siemens)
                                         : support::transimpedance_ratios(array, siemens);
    };
    const auto ratio = ratios_of(random_siemens(array, random));
    const auto fresh = invert(array, ratio);
    const auto inversion = inversion_for(array);
    std::vector<double> siemens(64);
    for (const auto& before : {ratios_of(random_siemens(array, random)), std::vector<double>(64, 1.0),
                               std::vector<double>(64, 0.0), ratio}) {
      (void)inversion->invert(before, siemens);
      EXPECT_TRUE(inversion->invert(ratio, siemens).solved);
      for (std::size_t k = 0; k < 64; ++k) EXPECT_NEAR(siemens[k], fresh.siemens[k], 1e-8);
      (void)inversion->invert(before, siemens);
      inversion->forget();
      EXPECT_TRUE(inversion->invert(ratio, siemens).solved);
      EXPECT_EQ(siemens, fresh.siemens);
      std::fill(siemens.begin(), siemens.end(), 1e9);
    }
  }
}

TEST(CrosstalkInversion, one_ratio_stands_for_the_conductance_of_the_load) {
  EXPECT_DOUBLE_EQ(inversion_for(make_array(2, 2))->siemens_per_ratio(), 1.0 / 200.0);
  EXPECT_DOUBLE_EQ(inversion_for(make_array(2, 2, Circuit::transimpedance))->siemens_per_ratio(), 1.0 / 200.0);
  EXPECT_DOUBLE_EQ(inversion_for(make_array(2, 2, Circuit::none))->siemens_per_ratio(), 1.0);
}

TEST(CrosstalkInversion, impossible_readings_are_refused_or_give_numbers_but_never_nan) {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    auto array = make_array(1 + random.below(16), 1 + random.below(16),
                            seed % 3 == 0 ? Circuit::transimpedance : Circuit::divider);
    scatter_resistors(array, random);
    std::vector<double> ratio(array.taxel_count());
    for (double& value : ratio) {
      switch (seed % 4) {
        case 0: value = 1.0; break;
        case 1: value = random.uniform(-1.0, 1.2); break;
        case 2: value = static_cast<double>(random.below(2)); break;
        default: value = random.uniform(); break;
      }
    }
    for (const double siemens : invert(array, ratio).siemens) ASSERT_TRUE(std::isfinite(siemens));
  }
}

TEST(CrosstalkInversion, a_taxel_that_conducts_better_than_its_driver_comes_back) {
  for (const double drive_ohm : {5.0, 20.0, 100.0}) {
    for (const double share : {0.3, 0.5, 1.0, 2.0}) {
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(testing::Message() << share << " of " << drive_ohm << " ohm, seed " << seed);
        Random random(seed);
        const std::size_t size = seed % 2 == 0 ? 4 : 16;
        const auto array = make_array(size, size, Circuit::divider, drive_ohm, 200.0);
        auto siemens = random_siemens(array, random);
        const std::size_t shorted = random.below(siemens.size());
        siemens[shorted] = 1.0 / (share * drive_ohm);
        const auto inverted = invert(array, support::divider_ratios(array, siemens));
        ASSERT_TRUE(inverted.solved);
        const auto columns = loaded_columns(array, siemens);
        for (std::size_t k = 0; k < siemens.size(); ++k) {
          ASSERT_NEAR(inverted.siemens[k], siemens[k], 1e-5 * columns[k % array.cols]) << "taxel " << k;
        }
      }
    }
  }
}

TEST(CrosstalkInversion, transimpedance_beyond_what_a_row_can_carry_has_no_solution) {
  // 16 columns at full scale would draw 16 / 200 of the supply per ohm through a driver of 20 ohm: 1.6 of the supply.
  const auto inverted = invert(make_array(2, 16, Circuit::transimpedance), std::vector<double>(32, 1.0));
  EXPECT_FALSE(inverted.solved);
  for (const double siemens : inverted.siemens) EXPECT_TRUE(std::isfinite(siemens));
}

TEST(CrosstalkInversion, floating_idle_rows_do_not_matter_to_a_virtual_ground) {
  auto array = make_array(2, 2, Circuit::transimpedance);
  array.readout.idle_rows = IdleRows::floating;
  EXPECT_TRUE(Compensator::create(array));
}

ConditionedFrame make_frame(std::vector<double> ratio) {
  ConditionedFrame frame;
  frame.taxels.assign(ratio.size(), TaxelStatus::ok);
  frame.ratio = std::move(ratio);
  return frame;
}

ConductanceFrame compensate(const ArrayDescription& array, const ConditionedFrame& conditioned) {
  ConductanceFrame conductance;
  Compensator::create(array)->process(conditioned, conductance);
  return conductance;
}

TEST(Compensator, gives_what_the_inversion_gives) {
  Random random(3);
  const auto array = make_array(3, 4);
  const auto ratio = support::divider_ratios(array, random_siemens(array, random));
  EXPECT_EQ(compensate(array, make_frame(ratio)).siemens, invert(array, ratio).siemens);
  EXPECT_EQ(Compensator::create(array)->siemens_per_ratio(), inversion_for(array)->siemens_per_ratio());
}

TEST(Compensator, time_temperature_and_flags_go_through) {
  auto frame = make_frame(std::vector<double>(4, 0.1));
  frame.time = Nanos(99);
  frame.temperature_celsius = 31.0;
  frame.status = FrameStatus::saturated;
  frame.taxels[2] = TaxelStatus::saturated;
  const auto conductance = compensate(make_array(2, 2), frame);
  EXPECT_EQ(conductance.time, Nanos(99));
  EXPECT_EQ(conductance.temperature_celsius, 31.0);
  EXPECT_EQ(conductance.status, FrameStatus::saturated);
  EXPECT_EQ(conductance.taxels, frame.taxels);
}

TEST(Compensator, rejected_frame_stays_rejected_and_holds_zeros) {
  auto frame = make_frame(std::vector<double>(4, 0.1));
  frame.status = FrameStatus::rejected;
  frame.taxels.assign(4, TaxelStatus::invalid);
  const auto conductance = compensate(make_array(2, 2), frame);
  EXPECT_EQ(conductance.status, FrameStatus::rejected);
  EXPECT_EQ(conductance.siemens, std::vector<double>(4, 0.0));
  EXPECT_EQ(conductance.taxels, std::vector<TaxelStatus>(4, TaxelStatus::invalid));
}

TEST(Compensator, frame_without_solution_is_flagged_and_its_taxels_are_invalid) {
  const auto conductance =
      compensate(make_array(1, 16, Circuit::transimpedance), make_frame(std::vector<double>(16, 1.0)));
  EXPECT_EQ(conductance.status, FrameStatus::not_converged);
  EXPECT_EQ(conductance.taxels, std::vector<TaxelStatus>(16, TaxelStatus::invalid));
}

TEST(Compensator, a_good_frame_after_a_bad_one_is_good) {
  const auto array = make_array(1, 16, Circuit::transimpedance);
  auto compensator = Compensator::create(array);
  ASSERT_TRUE(compensator);
  ConductanceFrame conductance;
  compensator->process(make_frame(std::vector<double>(16, 1.0)), conductance);
  const auto good = make_frame(std::vector<double>(16, 0.01));
  compensator->process(good, conductance);
  EXPECT_EQ(conductance.status, FrameStatus::ok);
  EXPECT_EQ(conductance.taxels, good.taxels);
  EXPECT_EQ(conductance.siemens, compensate(array, good).siemens);
}

TEST(Compensator, bad_readings_of_a_tenth_of_the_taxels_leave_most_frames_their_conductances) {
  constexpr int kFrames = 400;
  const ArrayDescription array = support::reference_array(16, 16);
  Random random(1);
  std::vector<double> siemens(array.taxel_count());
  for (double& value : siemens) value = 1.0 / random.log_uniform(2e3, 5e5);
  const std::vector<double> good = support::model_ratios(array, siemens);
  auto compensator = Compensator::create(array);
  ASSERT_TRUE(compensator);
  ConductanceFrame conductance;
  int solved = 0;
  for (int k = 0; k < kFrames; ++k) {
    ConditionedFrame frame = make_frame(good);
    frame.time = std::chrono::milliseconds(k);
    for (double& ratio : frame.ratio) ratio = random.uniform() < 0.1 ? random.uniform() : ratio;
    compensator->process(frame, conductance);
    solved += has(conductance.status, FrameStatus::not_converged) ? 0 : 1;
  }
  EXPECT_GE(solved, kFrames * 9 / 10);
}

}  // namespace
}  // namespace dermis::touch::compensation
