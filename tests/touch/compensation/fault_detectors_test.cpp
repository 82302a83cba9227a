// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Single detectors of line faults on readings by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "touch/compensation/faults/equal_presses.hpp"
#include "touch/compensation/faults/shorted_line_detector.hpp"
#include "touch/compensation/faults/stuck_taxel_detector.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kFullScale = 4095.0;
constexpr double kUnloadedSiemens = 5e-6;
constexpr double kUnloadedRatio = 0.001;

/// A divider of 6x8 taxels that nothing presses, and what detectors see of its readings.
class Bench {
 public:
  Bench()
      : array_(divider()),
        unloaded_(array_, std::vector<double>(array_.taxel_count(), kUnloadedSiemens)),
        sums_(array_),
        faults_(array_) {
    conductance_.siemens.assign(array_.taxel_count(), kUnloadedSiemens);
    conductance_.sigma_siemens.assign(array_.taxel_count(), 1e-7);
    conditioned_.sigma_ratio = array_.readout.adc_noise_counts / kFullScale;
    conditioned_.taxels.assign(array_.taxel_count(), TaxelStatus::ok);
    release();
  }

  void release() { conditioned_.ratio.assign(array_.taxel_count(), kUnloadedRatio); }
  double& reading(std::size_t row, std::size_t col) { return conditioned_.ratio[array_.index(row, col)]; }

  template <typename Detector>
  void show_to(Detector& detector) {
    sums_.sum(conditioned_, conductance_, true);
    unloaded_.expect(conditioned_, sums_, frame_, true);
    detector.judge({conditioned_, conductance_, sums_, unloaded_, witnesses_, frame_++, true}, faults_);
  }

  [[nodiscard]] const ArrayDescription& array() const { return array_; }
  [[nodiscard]] FaultList& faults() { return faults_; }

 private:
  static ArrayDescription divider() {
    ArrayDescription array;
    array.rows = 6;
    array.cols = 8;
    array.readout.drive_ohm.assign(6, 20.0);
    array.readout.load_ohm.assign(8, 200.0);
    return array;
  }

  ArrayDescription array_;
  UnloadedTaxels unloaded_;
  LineSums sums_;
  FaultList faults_;
  UnloadedWitnesses witnesses_;
  ConditionedFrame conditioned_;
  ConductanceFrame conductance_;
  std::size_t frame_ = 0;
};

/// Rows 2 and 3 pressed all along, equal at `equal_col` where they are pressed hardest, and scattering elsewhere.
void press_widely(Bench& bench, std::size_t equal_col) {
  bench.release();
  for (std::size_t col = 0; col < 8; ++col) {
    const bool is_equal = col == equal_col;
    const double mean = is_equal ? 0.5 : col % 2 == 0 ? 0.3 : 0.36;
    const double apart = is_equal ? 0.0 : col % 4 < 2 ? 0.05 : -0.05;
    bench.reading(1, col) = bench.reading(4, col) = 0.1;
    bench.reading(2, col) = mean * (1.0 + apart);
    bench.reading(3, col) = mean * (1.0 - apart);
  }
}

TEST(ShortedLineDetector, learns_from_a_wide_press_once_wherever_it_is_hardest) {
  Bench bench;
  EqualPresses learned;
  ShortedLineDetector detector(bench.array(), learned);
  for (const std::size_t col : {1U, 6U, 1U, 6U}) {
    press_widely(bench, col);
    bench.show_to(detector);
  }
  EXPECT_EQ(learned.evidence(4), 0.0);  // one press that scatters tells nothing yet
  for (const std::size_t col : {1U, 6U}) {
    bench.release();
    bench.show_to(detector);
    bench.reading(2, col) = bench.reading(3, col) = 0.5;  // another, that ends there
    bench.reading(1, col) = bench.reading(4, col) = 0.1;
    bench.show_to(detector);
    press_widely(bench, col);
    bench.show_to(detector);
  }
  EXPECT_LT(learned.evidence(4), 8.0);
}

/// Rows 2 and 3 read the same on three columns around `col`.
void press_shorted_rows(Bench& bench, std::size_t col) {
  bench.release();
  for (std::size_t k = col - 1; k <= col + 1; ++k) {
    bench.reading(1, k) = bench.reading(4, k) = 0.05;
    bench.reading(2, k) = bench.reading(3, k) = k == col ? 0.5 : 0.2 + 0.02 * static_cast<double>(k);
  }
}

TEST(ShortedLineDetector, forgets_the_presses_of_a_short_that_is_found) {
  Bench bench;
  EqualPresses learned;
  for (int press = 0; press < 6; ++press) learned.add({.equal = 0, .more = 2, .less = 2});
  const double before = learned.evidence(4);
  ShortedLineDetector detector(bench.array(), learned);
  for (int press = 0; press < 6 && bench.faults().all().empty(); ++press) {
    press_shorted_rows(bench, press % 2 == 0 ? 1 : 6);
    bench.show_to(detector);
    bench.release();
    bench.show_to(detector);
  }
  ASSERT_TRUE(bench.faults().contains(LineFaultKind::shorted_rows, 2));
  EXPECT_EQ(learned.evidence(4), before);
}

TEST(ShortedLineDetector, finds_three_rows_that_are_one) {
  Bench bench;
  EqualPresses learned;
  ShortedLineDetector detector(bench.array(), learned);
  for (int press = 0; press < 8; ++press) {
    const std::size_t col = press % 2 == 0 ? 1 : 6;
    bench.release();
    bench.reading(0, col) = bench.reading(4, col) = 0.1;
    for (const std::size_t row : {1U, 2U, 3U}) bench.reading(row, col) = 0.5;
    bench.show_to(detector);
    bench.release();
    bench.show_to(detector);
  }
  EXPECT_EQ(bench.faults().all().size(), 2U);
  EXPECT_TRUE(bench.faults().contains(LineFaultKind::shorted_rows, 1));
  EXPECT_TRUE(bench.faults().contains(LineFaultKind::shorted_rows, 2));
}

/// Noise on all taxels, a press beside the stuck one, which reads `stuck_counts`.
void read_with_noise(Bench& bench, Random& random, double stuck_counts) {
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t col = 0; col < 8; ++col) {
      bench.reading(row, col) = (20.0 + std::round(2.0 * random.normal())) / kFullScale;
    }
  }
  bench.reading(0, 0) = (3000.0 + std::round(5.0 * random.normal())) / kFullScale;
  bench.reading(3, 3) = stuck_counts / kFullScale;
}

/// GroundedLineDetector adds taxels that seemed dead and are stuck at 0.
TEST(StuckTaxelDetector, a_taxel_that_is_stuck_once_more_heals_as_slowly_as_at_first) {
  Bench bench;
  Random random(1);
  StuckTaxelDetector detector(bench.array());
  const std::size_t taxel = bench.array().index(3, 3);
  const auto is_stuck = [&] { return bench.faults().contains(LineFaultKind::stuck_taxel, taxel); };
  for (int frame = 0; frame < 300 && !is_stuck(); ++frame) {
    read_with_noise(bench, random, 1000.0);
    bench.show_to(detector);
  }
  ASSERT_TRUE(is_stuck());
  double counts = 1000.0;
  for (int frame = 0; frame < 20 && is_stuck(); ++frame) {
    read_with_noise(bench, random, counts += 7.0);
    bench.show_to(detector);
  }
  ASSERT_FALSE(is_stuck());
  bench.faults().add({.kind = LineFaultKind::stuck_taxel, .place = taxel});
  read_with_noise(bench, random, counts += 7.0);
  bench.show_to(detector);
  EXPECT_TRUE(is_stuck());
}

}  // namespace
}  // namespace dermis::touch::compensation
