// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/strip_training.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "learn/calibration/tables/monotone_knots.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kTaxels = 7;
constexpr double kPitch = 0.004;
constexpr double kLength = kPitch * (kTaxels - 1);

ArrayDescription strip(bool is_row) {
  ArrayDescription array;
  array.rows = is_row ? 1 : kTaxels;
  array.cols = is_row ? kTaxels : 1;
  array.row_pitch_m = array.col_pitch_m = kPitch;
  array.readout.circuit = Circuit::none;
  array.readout.adc_bits = 12;
  return array;
}

/// A strip of interdigitated electrodes: a touch reaches taxels `reach` pitches away (standard deviation), so those at
/// the ends feel touches whose other half no taxel feels.
class Touches {
 public:
  Touches(std::uint64_t seed, double reach) : random_(seed), reach_m_(reach * kPitch) {}

  void leave_alone(std::size_t frames) {
    for (std::size_t k = 0; k < frames; ++k) {
      loads.push_back({this->frames.size(), LoadKind::force, {0, 0, 0, 0}, 0.0});
      add(0.0, 0.0);
    }
  }

  void touch(std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      const double place = random_.uniform(0.0, kLength);
      const double newtons = random_.log_uniform(0.5, 5.0);
      positions.push_back({frames.size(), place});
      loads.push_back({frames.size(), LoadKind::force, {0, 0, 0, 0}, newtons});
      add(place, newtons);
    }
  }

  std::vector<RawFrame> frames;
  std::vector<Load> loads;  // of all taxels
  std::vector<TouchPosition> positions;

 private:
  void add(double place, double newtons) {
    RawFrame& frame = frames.emplace_back();
    frame.time = std::chrono::milliseconds(20 * frames.size());
    for (std::size_t taxel = 0; taxel < kTaxels; ++taxel) {
      const double away = (static_cast<double>(taxel) * kPitch - place) / reach_m_;
      const double counts = 40.0 + 500.0 * newtons * std::exp(-0.5 * away * away) + random_.normal();
      frame.counts.push_back(static_cast<float>(std::clamp(std::round(counts), 0.0, 4095.0)));
    }
  }

  Random random_;
  double reach_m_;
};

Touches touches_on(const ArrayDescription& array, std::uint64_t seed, std::size_t count, double reach) {
  Touches touches(seed, reach);
  touches.leave_alone(20);
  touches.touch(count);
  for (Load& load : touches.loads) load.where = all_taxels(array);
  return touches;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ssize(values) / 2, values.end());
  return values[values.size() / 2];
}

struct Errors {
  std::vector<double> of_tracker;
  std::vector<double> of_centre_of_mass;
  std::size_t within_two_sigma = 0;
};

Errors errors_of(const touch::pipeline::Model& model, const Touches& touches) {
  auto pipeline = touch::pipeline::Pipeline::create(model);
  touch::contacts::ContactTracker tracker(model.array, {}, model.strip);
  ForceFrame force;
  ContactReport report;
  Errors errors;
  auto next = touches.positions.begin();
  for (std::size_t k = 0; k < touches.frames.size() && next != touches.positions.end(); ++k) {
    pipeline->process(touches.frames[k], force);
    if (next->frame != k) continue;
    const double place = (next++)->along_m;
    double sum = 0.0;
    double moment = 0.0;
    for (std::size_t taxel = 0; taxel < kTaxels; ++taxel) {
      sum += double{force.newtons[taxel]};
      moment += double{force.newtons[taxel]} * static_cast<double>(taxel) * kPitch;
    }
    errors.of_centre_of_mass.push_back(std::abs(moment / sum - place));
    tracker.forget();
    tracker.process(force, report);
    EXPECT_EQ(report.contacts.size(), 1U) << "frame " << k;
    if (report.contacts.empty()) continue;
    const bool is_row = model.array.rows == 1;
    const Contact& contact = report.contacts.front();
    errors.of_tracker.push_back(std::abs((is_row ? contact.position.x : contact.position.y) - place));
    const double sigma = is_row ? contact.sigma_position_m.x : contact.sigma_position_m.y;
    if (errors.of_tracker.back() <= 2.0 * sigma) ++errors.within_two_sigma;
  }
  return errors;
}

TEST(StripTraining, learned_positions_are_at_least_four_tenths_nearer_than_the_centre_of_mass) {
  for (const bool is_row : {true, false}) {
    const ArrayDescription array = strip(is_row);
    for (const double reach : {0.8, 1.2, 2.0}) {
      const Touches known = touches_on(array, 1, 400, reach);
      Result<Calibration> calibration = calibrate(array, known.frames, known.loads);
      ASSERT_TRUE(calibration) << calibration.error().message;
      const auto table = train_strip(calibration->model, known.frames, known.positions);
      ASSERT_TRUE(table) << table.error().message;
      calibration->model.strip = *table;
      const Errors errors = errors_of(calibration->model, touches_on(array, 2, 400, reach));
      EXPECT_LT(median(errors.of_tracker), 0.6 * median(errors.of_centre_of_mass)) << "reach " << reach;
      EXPECT_GT(errors.within_two_sigma, 340U) << "reach " << reach;
      RecordProperty("median_error_um", static_cast<int>(1e6 * median(errors.of_tracker)));
      RecordProperty("centre_of_mass_um", static_cast<int>(1e6 * median(errors.of_centre_of_mass)));
    }
  }
}

TEST(StripTraining, says_what_is_wrong_with_positions) {
  const ArrayDescription array = strip(true);
  Touches known = touches_on(array, 3, 40, 1.2);
  const Result<Calibration> calibration = calibrate(array, known.frames, known.loads);
  ASSERT_TRUE(calibration) << calibration.error().message;
  const auto few = train_strip(calibration->model, known.frames, std::span(known.positions).first(15));
  ASSERT_FALSE(few);
  EXPECT_EQ(few.error().message, "15 of 15 frames with a position have a contact; at least 16 are needed");
  for (TouchPosition& position : known.positions) position.along_m = kLength - position.along_m;
  const auto reversed = train_strip(calibration->model, known.frames, known.positions);
  ASSERT_FALSE(reversed);
  EXPECT_EQ(reversed.error().message,
            "positions do not rise with the centre of mass: they are counted from the first taxel on");
}

/// Touches that one taxel alone feels have its place, whatever theirs is.
TEST(StripTraining, touches_with_equal_centres_of_mass_are_one_knot) {
  std::vector<Knot> knots = {{0.0, 0.0, 1.0}, {0.0, 1e-3, 3.0}, {1e-9, 2e-3, 1.0}, {0.004, 3e-3, 2.0}};
  merge_equal(knots, 1e-6);
  ASSERT_EQ(knots.size(), 2U);
  EXPECT_NEAR(knots[0].y, 1e-3, 1e-12);
  EXPECT_EQ(knots[0].weight, 5.0);
  EXPECT_EQ(knots[1].y, 3e-3);
}

}  // namespace
}  // namespace dermis::learn::calibration
