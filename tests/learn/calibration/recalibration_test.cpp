// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/recalibration.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLines = 4;
constexpr std::size_t kTaxels = kLines * kLines;
constexpr FrameShape kShape{kLines, kLines};

KnownPress press_of(std::size_t taxel, double log_ratio, double sigma) {
  return {{taxel}, {1.0}, log_ratio, sigma};
}

TEST(GainChange, one_weight_moves_the_whole_sheet_as_far_as_it_is_sure) {
  const std::vector<KnownPress> sure{press_of(3, -0.095, 0.005)};
  const GainChange change = change_of(sure, kShape);
  EXPECT_NEAR(change.sheet, -0.095, 0.001);
  EXPECT_NEAR(change.sheet_sigma, 0.005, 1e-4);
  EXPECT_EQ(change.spread, 0.0);
  for (const double taxel : change.taxels) EXPECT_EQ(taxel, change.sheet);
  const std::vector<KnownPress> unsure{press_of(3, -0.095, 0.1)};
  EXPECT_NEAR(change_of(unsure, kShape).sheet, -0.095 / 2.0, 1e-9);  // as likely as what was known before
}

TEST(GainChange, some_weights_tell_taxels_apart_and_leave_the_others_with_the_sheet) {
  std::vector<KnownPress> presses;
  const auto change_at = [](std::size_t taxel) { return (taxel + taxel / kLines) % 2 == 0 ? 0.2 : 0.0; };
  for (std::size_t taxel = 0; taxel < 8; ++taxel) presses.push_back(press_of(taxel, change_at(taxel), 0.01));
  const GainChange change = change_of(presses, kShape);
  EXPECT_NEAR(change.sheet, 0.1, 0.02);
  EXPECT_NEAR(change.spread, 0.1, 0.03);
  EXPECT_EQ(change.row_share + change.column_share, 0.0);
  for (std::size_t taxel = 0; taxel < 8; ++taxel) EXPECT_NEAR(change.taxels[taxel], change_at(taxel), 0.01);
  for (std::size_t taxel = 8; taxel < kTaxels; ++taxel) EXPECT_EQ(change.taxels[taxel], change.sheet);
}

TEST(GainChange, differences_within_the_scatter_of_presses_leave_the_taxels_alike) {
  std::vector<KnownPress> presses;
  for (std::size_t taxel = 0; taxel < 8; ++taxel) {
    presses.push_back(press_of(taxel, taxel % 2 == 0 ? 0.13 : 0.07, 0.06));
  }
  const GainChange change = change_of(presses, kShape);
  EXPECT_EQ(change.spread, 0.0);
  for (const double taxel : change.taxels) EXPECT_EQ(taxel, change.sheet);
}

struct Errors {
  double before = 0.0;
  double after = 0.0;
};

/// Mean square errors of the gains of many sheets, with presses on so many taxels.
Errors errors_of(std::size_t presses, double common, double spread, double sigma, Random& random) {
  constexpr int kSheets = 400;
  Errors errors;
  for (int sheet = 0; sheet < kSheets; ++sheet) {
    const double change = common * random.normal();
    std::vector<double> gains(kTaxels);
    for (double& gain : gains) gain = change + spread * random.normal();
    std::vector<KnownPress> known;
    for (std::size_t k = 0; k < presses; ++k) known.push_back(press_of(k, gains[k] + sigma * random.normal(), sigma));
    const GainChange found = change_of(known, kShape);
    for (std::size_t k = 0; k < kTaxels; ++k) {
      errors.before += gains[k] * gains[k];
      errors.after += std::pow(gains[k] - found.taxels[k], 2);
    }
  }
  return errors;
}

TEST(GainChange, few_weights_make_aged_sheets_better_and_not_worse) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  for (const double spread : {0.0, 0.05, 0.1}) {
    for (const double sigma : {0.01, 0.06}) {
      double last = std::numeric_limits<double>::infinity();
      for (const std::size_t presses : {1U, 3U, 5U, 10U, 16U}) {
        const Errors errors = errors_of(presses, 0.1, spread, sigma, random);
        EXPECT_LT(errors.after, errors.before) << spread << " " << sigma << " " << presses;
        EXPECT_LT(errors.after / errors.before, 1.1 * last) << spread << " " << sigma << " " << presses;
        last = errors.after / errors.before;
      }
    }
  }
}

/// How gains of a sheet change, as standard deviations.
struct SheetChange {
  double sheet = 0.1;
  double rows = 0.0;
  double columns = 0.0;
  double taxels = 0.0;

  [[nodiscard]] std::vector<double> play(const FrameShape& shape, Random& random) const {
    const double common = sheet * random.normal();
    std::vector<double> of_rows(shape.rows);
    std::vector<double> of_columns(shape.cols);
    for (double& row : of_rows) row = rows * random.normal();
    for (double& column : of_columns) column = columns * random.normal();
    std::vector<double> gains;
    for (std::size_t k = 0; k < shape.taxel_count(); ++k) {
      gains.push_back(common + of_rows[k / shape.cols] + of_columns[k % shape.cols] + taxels * random.normal());
    }
    return gains;
  }
};

/// Shares of errors within one and two standard deviations, in per cent.
struct Covered {
  double taxels_1 = 0.0;
  double taxels_2 = 0.0;
  double sums_1 = 0.0;
  double sums_2 = 0.0;
};

/// Of taxels, and of sums over squares of 3 x 3, on 10 x 10 taxels. Each press lies on another row and column.
Covered covered(const SheetChange& by, std::size_t presses, Random& random) {
  constexpr FrameShape kSheet{10, 10};
  constexpr double kSigma = 0.007;
  constexpr int kSheets = 300;
  Covered covered;
  for (int sheet = 0; sheet < kSheets; ++sheet) {
    const std::vector<double> gains = by.play(kSheet, random);
    std::vector<KnownPress> known;
    for (std::size_t k = 0; k < presses; ++k) {
      const std::size_t taxel = (k % 10) * 10 + (3 * k + k / 10) % 10;
      known.push_back(press_of(taxel, gains[taxel] + kSigma * random.normal(), kSigma));
    }
    const GainChange found = change_of(known, kSheet);
    const auto count = [&](double error, double sigma, double& one, double& two) {
      one += std::abs(error) < sigma ? 100.0 / kSheets : 0.0;
      two += std::abs(error) < 2.0 * sigma ? 100.0 / kSheets : 0.0;
    };
    const auto taxel = static_cast<std::size_t>(random.uniform() * 100.0);
    const double sigma = std::hypot(kSigma, found.left.sigma[taxel]);
    count(found.taxels[taxel] - gains[taxel] + kSigma * random.normal(), sigma, covered.taxels_1, covered.taxels_2);
    const std::vector<float> newtons(kSheet.taxel_count(), 1.0F);
    std::vector<std::size_t> square;
    double error = 0.0;
    const std::size_t corner = static_cast<std::size_t>(random.uniform() * 8.0) * 11;
    for (std::size_t k = 0; k < 9; ++k) {
      square.push_back(corner + k / 3 * 10 + k % 3);
      error += found.taxels[square.back()] - gains[square.back()];
    }
    count(error, std::sqrt(found.left.variance(newtons, square)), covered.sums_1, covered.sums_2);
  }
  return covered;
}

TEST(GainChange, what_weights_did_not_mend_is_in_the_standard_deviations) {
  constexpr std::uint64_t kSeed = 9;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  const std::vector<SheetChange> changes{{.rows = 0.1}, {.columns = 0.1}, {.taxels = 0.1}, {.rows = 0.03}};
  for (const SheetChange& change : changes) {
    for (const std::size_t presses : {5U, 10U, 30U}) {
      const Covered share = covered(change, presses, random);
      SCOPED_TRACE(testing::Message() << change.rows << " " << change.columns << " " << change.taxels << ", " << presses
                                      << " presses: " << share.taxels_1 << "/" << share.taxels_2 << ", sums "
                                      << share.sums_1 << "/" << share.sums_2);
      EXPECT_GT(share.taxels_1, 58.0);
      EXPECT_GT(share.taxels_2, 87.0);
      EXPECT_GT(share.sums_1, 55.0);
      EXPECT_GT(share.sums_2, 85.0);
      EXPECT_LT(share.taxels_1, 84.0);
    }
  }
}

TEST(GainChange, weights_on_a_sheet_that_has_not_changed_widen_it_by_no_more_than_they_scatter) {
  constexpr std::uint64_t kSeed = 10;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  double sum = 0.0;
  for (int sheet = 0; sheet < 200; ++sheet) {
    std::vector<KnownPress> known;
    for (std::size_t k = 0; k < 5; ++k) known.push_back(press_of(3 * k, 0.01 * random.normal(), 0.01));
    sum += std::pow(change_of(known, kShape).left.sigma[1], 2) / 200.0;
  }
  EXPECT_LT(std::sqrt(sum), 0.012);
}

TEST(GainChange, rows_that_weights_prove_are_mended_where_nothing_pressed) {
  constexpr std::uint64_t kSeed = 11;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  const SheetChange by_rows{.rows = 0.1};
  const std::vector<double> gains = by_rows.play(kShape, random);
  std::vector<KnownPress> known;
  for (const std::size_t taxel : {0U, 1U, 2U, 4U, 6U, 7U, 8U, 9U, 11U, 12U, 13U, 15U}) {
    known.push_back(press_of(taxel, gains[taxel] + 0.005 * random.normal(), 0.005));
  }
  const GainChange found = change_of(known, kShape);
  EXPECT_GE(found.row_share, 0.9);
  for (const std::size_t taxel : {3U, 5U, 10U, 14U}) {
    EXPECT_NEAR(found.taxels[taxel], gains[taxel], 0.02);
    EXPECT_LT(found.left.sigma[taxel], 0.06F);
  }
}

/// A sheet of 4 x 4 taxels that reads its gains times the forces, at 10 frames a second.
struct PlayedPresses {
  touch::pipeline::Model model = support::hand_made_model(kLines, kLines);
  std::vector<double> gains = std::vector<double>(kTaxels, 1.0);
  std::vector<RawFrame> frames;
  std::vector<Load> loads;

  PlayedPresses() { hold({}, 0.0, 20); }

  /// `newtons` on each of the taxels for some frames, which have labels where there is one.
  void hold(const std::vector<std::size_t>& taxels, double newtons, std::size_t count, std::optional<Load> label = {}) {
    std::vector<double> siemens(kTaxels);
    std::vector<double> force(kTaxels);
    for (const std::size_t taxel : taxels) force[taxel] = newtons;
    for (std::size_t k = 0; k < kTaxels; ++k) {
      siemens[k] = support::siemens_under(model, k, gains[k] * force[k], 25.0);
    }
    RawFrame raw;
    raw.temperature_celsius = 25.0;
    raw.supply_v = 5.0;
    raw.counts.resize(kTaxels);
    std::vector<double> ratio(kTaxels);
    simulation::ReadoutCircuit::create(model.array)->ratios(siemens, ratio);
    for (std::size_t k = 0; k < kTaxels; ++k) {
      raw.counts[k] = static_cast<float>(std::lround(ratio[k] * model.array.readout.full_scale_counts()));
    }
    for (; count > 0; --count) {
      raw.time = frames.size() * std::chrono::milliseconds(100);
      if (label) {
        label->frame = frames.size();
        loads.push_back(*label);
      }
      frames.push_back(raw);
    }
  }

  void weigh(std::size_t taxel, double newtons) {
    const TaxelRegion where{taxel / kLines, taxel % kLines, taxel / kLines, taxel % kLines};
    hold({taxel}, newtons, 10, Load{0, LoadKind::force, where, newtons});
    hold({}, 0.0, 5);
  }

  [[nodiscard]] std::vector<float> read(const touch::pipeline::Model& by, std::size_t frame) const {
    touch::pipeline::Pipeline pipeline = touch::pipeline::Pipeline::create(by).value();
    ForceFrame force;
    pipeline.process(frames[frame], force);
    return force.newtons;
  }
};

TEST(Recalibration, a_known_weight_on_one_taxel_mends_all_taxels) {
  PlayedPresses played;
  played.gains.assign(kTaxels, 1.1);
  played.weigh(5, 5.0);
  played.hold({10}, 8.0, 1);
  const std::size_t last = played.frames.size() - 1;
  EXPECT_NEAR(played.read(played.model, last)[10], 8.8, 0.02);
  const Result<Recalibration> made = recalibrate(played.model, played.frames, played.loads);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->presses, 1U);
  EXPECT_NEAR(played.read(made->model, last)[10], 8.0, 0.03);
  EXPECT_NE(describe(*made).find("the sheet read 10.0 % too much"), std::string::npos) << describe(*made);
  EXPECT_EQ(made->model.networks.parameters, played.model.networks.parameters);
}

TEST(Recalibration, a_pressure_presses_no_absent_taxel) {
  PlayedPresses played;
  played.model.array.taxel_area_m2 = 1e-4;
  played.model.array.absent = {6};
  const TaxelRegion pair{1, 1, 1, 2};
  played.hold({5}, 5.0, 10, Load{0, LoadKind::pressure, pair, 5e4});
  played.hold({}, 0.0, 5);
  const Result<Recalibration> made = recalibrate(played.model, played.frames, played.loads);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_NEAR(made->change.sheet, 0.0, 0.01);
}

TEST(Recalibration, tables_and_heaviest_loads_are_scaled_with_their_taxels) {
  PlayedPresses played;
  touch::fusion::ForceNetworks& networks = played.model.networks;
  networks.heaviest_newtons.assign(kTaxels, 20.0F);
  networks.tables = {{10}, 2, {1e-4F, 5e-3F}, {1.0F, 40.0F}, {0.0F}};
  played.gains.assign(kTaxels, 1.1);
  played.weigh(5, 5.0);
  played.hold({10}, 8.0, 1);
  const std::size_t last = played.frames.size() - 1;
  const Result<Recalibration> made = recalibrate(played.model, played.frames, played.loads);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_NEAR(made->model.networks.heaviest_newtons[0], 20.0 / 1.1, 0.05);
  EXPECT_NEAR(played.read(made->model, last)[10] / played.read(played.model, last)[10], 1.0 / 1.1, 0.003);
  EXPECT_TRUE(made->model.networks.is_consistent());
}

TEST(Recalibration, comes_on_top_of_the_one_before) {
  PlayedPresses played;
  played.gains.assign(kTaxels, 1.1);
  played.weigh(5, 5.0);
  const touch::pipeline::Model once = recalibrate(played.model, played.frames, played.loads)->model;
  const Result<Recalibration> twice = recalibrate(once, played.frames, played.loads);
  ASSERT_TRUE(twice);
  EXPECT_NEAR(twice->change.sheet, 0.0, 0.001);
  EXPECT_NEAR(twice->model.networks.gain[0], 1.0 / 1.1, 0.002);
}

TEST(Recalibration, weights_on_several_taxels_mend_each) {
  PlayedPresses played;
  for (std::size_t k = 0; k < kTaxels; ++k) played.gains[k] = k % 2 == 0 ? 1.1 : 0.9;
  for (std::size_t k = 0; k < 8; ++k) played.weigh(k, 5.0);
  const Result<Recalibration> made = recalibrate(played.model, played.frames, played.loads);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->taxels, 8U);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR(made->model.networks.gain[k] * played.gains[k], 1.0, 0.01);
}

TEST(Recalibration, writes_what_is_left_into_the_model_and_forgets_it_when_weights_agree) {
  PlayedPresses played;
  for (std::size_t k = 0; k < kTaxels; ++k) played.gains[k] = (k * 7) % 3 == 0 ? 1.12 : 0.9;
  for (const std::size_t k : {0U, 5U, 10U, 15U, 2U}) played.weigh(k, 5.0);
  const Result<Recalibration> made = recalibrate(played.model, played.frames, played.loads);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_GT(made->model.networks.gain_errors.sigma[7], 0.06F);
  EXPECT_LT(made->model.networks.gain_errors.sigma[5], 0.02F);
  EXPECT_NE(describe(*made).find("forces are"), std::string::npos) << describe(*made);

  PlayedPresses one;
  one.weigh(7, 5.0);
  const Result<Recalibration> with_one = recalibrate(made->model, one.frames, one.loads);
  ASSERT_TRUE(with_one);
  EXPECT_GE(with_one->model.networks.gain_errors.sigma[7], made->model.networks.gain_errors.sigma[7]);
}

TEST(Recalibration, a_sheet_that_conducts_more_unloaded_gets_its_zero_back) {
  PlayedPresses played;
  for (const double share : {1.0, 1.2}) {
    touch::pipeline::Model calibrated = played.model;
    for (double& siemens : calibrated.networks.unloaded.offset_siemens) siemens /= share;
    PlayedPresses now = played;
    now.weigh(5, 5.0);
    now.hold({}, 0.0, 30);
    const Result<Recalibration> made = recalibrate(calibrated, now.frames, now.loads);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_NEAR(made->unloaded, share - 1.0, 0.01);
    const double zero = made->model.networks.unloaded.offset_siemens[3];
    EXPECT_NEAR(zero / played.model.networks.unloaded.offset_siemens[3], 1.0, 0.01);
  }
}

TEST(Recalibration, a_press_with_several_labels_is_one_and_two_presses_in_a_place_are_two) {
  PlayedPresses played;
  played.weigh(5, 5.0);
  played.weigh(5, 5.0);
  EXPECT_EQ(recalibrate(played.model, played.frames, played.loads)->presses, 2U);
}

TEST(Recalibration, a_weight_on_several_taxels_is_held_against_their_sum) {
  PlayedPresses played;
  played.gains.assign(kTaxels, 0.9);
  played.hold({0, 1, 4, 5}, 2.0, 10, Load{0, LoadKind::force, {0, 0, 1, 1}, 8.0});
  const Result<Recalibration> made = recalibrate(played.model, played.frames, played.loads);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_NEAR(made->change.sheet, -std::log(0.9), 0.002);
}

TEST(Recalibration, needs_a_load_that_has_a_force) {
  PlayedPresses played;
  EXPECT_FALSE(recalibrate(played.model, played.frames, played.loads));
  played.hold({}, 0.0, 5, Load{0, LoadKind::force, {0, 0, 0, 0}, 5.0});
  const Result<Recalibration> made = recalibrate(played.model, played.frames, played.loads);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("a known weight is needed"), std::string::npos);
}

}  // namespace
}  // namespace dermis::learn::calibration
