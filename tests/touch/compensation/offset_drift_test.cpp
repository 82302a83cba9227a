// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/compensation/offset_drift.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "dermis/learn/simulation/rubber.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr FrameShape kShape{8, 8};
constexpr std::size_t kTaxels = 64;
constexpr double kCentreCelsius = 25.0;
constexpr double kHalfSpanCelsius = 25.0;
constexpr double kSigmaSiemens = 1.3e-6;  // The reference array: 12 bit over 200 ohm.

std::size_t at(std::size_t row, std::size_t col) {
  return row * kShape.cols + col;
}

/// An array of rubber whose unloaded conductance has been calibrated, read by instruments with white noise.
class Skin {
 public:
  explicit Skin(const learn::simulation::RubberOptions& options = {}, double sigma_siemens = kSigmaSiemens)
      : rubber_(learn::simulation::ConductiveRubber::create(options, kShape.rows, kShape.cols, 11).value()),
        sigma_siemens_(sigma_siemens),
        random_(7),
        force_n(kTaxels, 0.0),
        offset_error(kTaxels, 0.0) {
    frame_.siemens.resize(kTaxels);
    frame_.sigma_siemens.assign(kTaxels, sigma_siemens);
    frame_.taxels.assign(kTaxels, TaxelStatus::ok);
  }

  [[nodiscard]] UnloadedConductance calibration() const {
    UnloadedConductance unloaded;
    unloaded.law.temperature = {kCentreCelsius, kHalfSpanCelsius};
    for (std::size_t k = 0; k < kTaxels; ++k) {
      const double cold = rubber_.conductance_from_force(k, 0.0, kCentreCelsius - kHalfSpanCelsius);
      const double hot = rubber_.conductance_from_force(k, 0.0, kCentreCelsius + kHalfSpanCelsius);
      unloaded.law.offset_siemens.push_back(0.5 * (cold + hot));
      unloaded.law.per_celsius.push_back(0.5 * (hot - cold) / kHalfSpanCelsius);
      unloaded.sigma_siemens.push_back(0.1 * sigma_siemens_);
    }
    return unloaded;
  }

  /// `seconds` later.
  ConductanceFrame& read(double seconds) {
    rubber_.press(force_n, seconds);
    rubber_.read(celsius, frame_.siemens);
    for (std::size_t k = 0; k < kTaxels; ++k) {
      frame_.siemens[k] = std::max(0.0, frame_.siemens[k] + offset_error[k] + sigma_siemens_ * random_.normal());
    }
    time_s_ += seconds;
    frame_.time = Nanos(std::llround(1e9 * time_s_));
    frame_.temperature_celsius = celsius;
    frame_.taxels.assign(kTaxels, TaxelStatus::ok);
    frame_.status = FrameStatus::ok;
    return frame_;
  }

  /// Reads for so long, calls `each` before each frame, and gives the mean corrected excess of the last second [S].
  std::vector<double> live(OffsetDrift& drift, double seconds, double rate_hz,
                           const std::function<void(double)>& each = {}) {
    const auto frames = static_cast<std::size_t>(std::llround(seconds * rate_hz));
    const auto last = std::min(frames, static_cast<std::size_t>(std::max(1.0, rate_hz)));
    const UnloadedLaw unloaded = calibration().law;
    std::vector<double> mean(kTaxels, 0.0);
    for (std::size_t i = 0; i < frames; ++i) {
      if (each) each(static_cast<double>(i) / rate_hz);
      drift.process(read(1.0 / rate_hz));
      if (i + last < frames) continue;
      for (std::size_t k = 0; k < kTaxels; ++k) {
        const double expected = unloaded.at(k, celsius - kCentreCelsius);
        mean[k] += (frame_.siemens[k] - expected) / static_cast<double>(last);
      }
    }
    return mean;
  }

  /// Of an excess over the unloaded taxel.
  [[nodiscard]] double newtons(std::size_t taxel, double excess_siemens) const {
    const double unloaded = rubber_.conductance_from_force(taxel, 0.0, celsius);
    return rubber_.force_from_conductance(taxel, unloaded + excess_siemens, celsius);
  }
  [[nodiscard]] double excess(std::size_t taxel, double newtons) const {
    return rubber_.conductance_from_force(taxel, newtons, celsius) -
           rubber_.conductance_from_force(taxel, 0.0, celsius);
  }
  /// By the calibration, which is 5 % higher than the truth at the centre: the law is bent.
  [[nodiscard]] double unloaded(std::size_t taxel) const { return calibration().law.offset_siemens[taxel]; }

 private:
  learn::simulation::ConductiveRubber rubber_;
  double sigma_siemens_;
  Random random_;
  ConductanceFrame frame_;
  double time_s_ = 0.0;

 public:
  std::vector<double> force_n;
  std::vector<double> offset_error;  // [S]
  double celsius = 20.0;
};

OffsetDrift tracking(const Skin& skin) {
  return OffsetDrift(kShape, skin.calibration(), {.track = true});
}

std::vector<double> copy(std::span<const double> values) {
  return {values.begin(), values.end()};
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Unloaded taxels of 5 kohm: conductive fabric under Velostat.
learn::simulation::RubberOptions leaky_rubber() {
  learn::simulation::RubberOptions options;
  options.unloaded_ohm = 5000.0;
  return options;
}

TEST(OffsetDrift, leaves_frames_alone_until_it_is_asked_to) {
  Skin skin;
  OffsetDrift drift(kShape, skin.calibration());
  EXPECT_FALSE(drift.options().track);
  for (int i = 0; i < 300; ++i) {
    ConductanceFrame& frame = skin.read(0.02);
    const std::vector<double> before = frame.siemens;
    drift.process(frame);
    EXPECT_EQ(frame.siemens, before);
  }
  EXPECT_EQ(copy(drift.offsets()), std::vector<double>(kTaxels, 0.0));
}

TEST(OffsetDrift, a_press_of_ten_minutes_loses_nothing_while_it_warms_up_by_ten_celsius) {
  for (const double unloaded_ohm : {200e3, 5e3}) {
    learn::simulation::RubberOptions options;
    options.unloaded_ohm = unloaded_ohm;
    Skin skin(options);
    OffsetDrift drift = tracking(skin);
    skin.live(drift, 60.0, 10.0);
    const std::vector<std::pair<std::size_t, double>> presses = {{at(2, 2), 5.0}, {at(2, 3), 0.2}, {at(6, 5), 20.0}};
    for (const auto& [taxel, force] : presses) skin.force_n[taxel] = force;
    const std::vector<double> at_first = skin.live(drift, 20.0, 10.0);
    const std::vector<double> offsets = copy(drift.offsets());
    std::vector<double> newtons_at_first;
    for (const auto& [taxel, force] : presses) newtons_at_first.push_back(skin.newtons(taxel, at_first[taxel]));
    const std::vector<double> at_last =
        skin.live(drift, 600.0, 10.0, [&](double t) { skin.celsius = 20.0 + 10.0 * t / 600.0; });
    for (std::size_t p = 0; p < presses.size(); ++p) {
      const auto [taxel, force] = presses[p];
      EXPECT_EQ(drift.offsets()[taxel], offsets[taxel]) << "nothing is followed under a press";
      const double noise = force < 1.0 ? 0.04 : 0.0;  // of the mean over 10 frames
      EXPECT_NEAR(skin.newtons(taxel, at_last[taxel]), newtons_at_first[p], (0.01 + noise) * force) << unloaded_ohm;
    }
    EXPECT_EQ(drift.offsets()[at(1, 2)], offsets[at(1, 2)]) << "nor beside one";
  }
}

TEST(OffsetDrift, a_wrong_offset_of_idle_taxels_is_found) {
  Skin skin(leaky_rubber());
  OffsetDrift drift = tracking(skin);
  Random random(3);
  for (double& error : skin.offset_error) error = 0.05 * skin.unloaded(0) * random.uniform(-1.0, 1.0);
  const double before = rms(skin.offset_error);
  EXPECT_LT(rms(skin.live(drift, 20.0, 50.0)), 0.6 * before);
  EXPECT_LT(rms(skin.live(drift, 100.0, 50.0)), 0.1 * before);
}

TEST(OffsetDrift, slow_noise_of_idle_taxels_shrinks) {
  learn::simulation::RubberOptions options = leaky_rubber();
  options.pink_noise = 1e-5;
  Skin skin(options);
  Skin same(options);
  OffsetDrift drift = tracking(skin);
  OffsetDrift none(kShape, same.calibration());
  double tracked = 0.0;
  double untracked = 0.0;
  for (int minute = 0; minute < 10; ++minute) {
    const double with = rms(skin.live(drift, 60.0, 10.0));
    const double without = rms(same.live(none, 60.0, 10.0));
    if (minute < 2) continue;
    tracked += with;
    untracked += without;
  }
  EXPECT_LT(tracked, 0.8 * untracked);
}

TEST(OffsetDrift, a_load_that_grows_slowly_is_not_eaten) {
  for (const double unloaded_ohm : {200e3, 5e3}) {
    learn::simulation::RubberOptions options;
    options.unloaded_ohm = unloaded_ohm;
    for (const double minutes : {1.0, 10.0, 100.0}) {
      Skin skin(options);
      OffsetDrift drift = tracking(skin);
      skin.live(drift, 60.0, 10.0);
      skin.live(drift, 60.0 * minutes, 10.0 / minutes,
                [&](double t) { skin.force_n[at(3, 3)] = 5.0 * t / (60.0 * minutes); });
      const double band = 0.1 * skin.unloaded(at(3, 3)) + 2.0 * kSigmaSiemens;
      const double range = 0.5 * skin.unloaded(at(3, 3)) + 3.3 * kSigmaSiemens;
      EXPECT_LT(drift.offsets()[at(3, 3)], minutes > 1.0 ? range : band) << unloaded_ohm;
      if (minutes == 1.0) {
        EXPECT_LT(skin.newtons(at(3, 3), band), 0.15);
      }
    }
  }
}

TEST(OffsetDrift, following_alone_takes_no_more_than_its_range_however_slowly_it_is_led) {
  Skin skin(leaky_rubber());
  OffsetDrift drift = tracking(skin);
  const double unloaded = skin.unloaded(at(4, 4));
  skin.live(drift, 8000.0, 1.0, [&](double t) { skin.offset_error[at(4, 4)] = unloaded * t / 8000.0; });
  EXPECT_GT(drift.offsets()[at(4, 4)], 0.4 * unloaded);
  EXPECT_LE(drift.offsets()[at(4, 4)], 0.5 * unloaded + 3.3 * kSigmaSiemens);
}

TEST(OffsetDrift, tare_takes_a_load_for_zero_and_a_press_on_it_reads_right) {
  learn::simulation::RubberOptions options;
  options.exponent = 1.0;
  options.exponent_spread = 0.0;
  Skin skin(options);
  OffsetDrift drift(kShape, skin.calibration());
  std::fill(skin.force_n.begin(), skin.force_n.end(), 0.5);
  drift.tare();
  EXPECT_TRUE(drift.taring());
  skin.live(drift, 1.5, 100.0);
  EXPECT_FALSE(drift.taring());
  for (const double excess : skin.live(drift, 5.0, 100.0)) EXPECT_NEAR(excess, 0.0, kSigmaSiemens);
  skin.force_n[at(3, 4)] = 5.5;
  EXPECT_NEAR(skin.newtons(at(3, 4), skin.live(drift, 2.0, 100.0)[at(3, 4)]), 5.0, 0.05);
  std::fill(skin.force_n.begin(), skin.force_n.end(), 0.5);
  drift.reset();
  EXPECT_NEAR(skin.newtons(0, skin.live(drift, 2.0, 100.0)[0]), 0.5, 0.01);
}

TEST(OffsetDrift, tare_of_an_array_that_is_at_zero_adds_no_noise) {
  Skin skin;
  OffsetDrift drift(kShape, skin.calibration());
  for (const double rate_hz : {100.0, 5.0}) {
    drift.tare();
    skin.live(drift, 3.0, rate_hz);
    const double averaged = std::max(10.0, rate_hz);
    EXPECT_LT(rms(copy(drift.offsets())), 0.8 * kSigmaSiemens / std::sqrt(averaged)) << rate_hz;
  }
}

TEST(OffsetDrift, a_tare_is_followed_and_the_tared_load_may_leave_and_come_back) {
  Skin skin;
  OffsetDrift drift = tracking(skin);
  skin.force_n[at(5, 5)] = 1.0;
  drift.tare();
  skin.live(drift, 2.0, 50.0);
  const double tared = drift.offsets()[at(5, 5)];
  EXPECT_NEAR(tared, skin.excess(at(5, 5), 1.0), 0.02 * tared);
  skin.force_n[at(5, 5)] = 0.0;
  skin.live(drift, 120.0, 10.0);
  EXPECT_NEAR(drift.offsets()[at(5, 5)], tared, 1e-3 * tared);
  skin.force_n[at(5, 5)] = 1.0;
  EXPECT_NEAR(skin.newtons(at(5, 5), skin.live(drift, 5.0, 10.0)[at(5, 5)]), 0.0, 0.02);
}

TEST(OffsetDrift, rubber_that_creeps_back_is_not_taken_for_drift) {
  learn::simulation::RubberOptions options = leaky_rubber();
  options.creep = 0.1;
  Skin skin(options);
  OffsetDrift drift = tracking(skin);
  skin.live(drift, 60.0, 10.0);
  skin.force_n[at(3, 3)] = 20.0;
  skin.live(drift, 120.0, 10.0);
  const std::vector<double> offsets = copy(drift.offsets());
  skin.force_n[at(3, 3)] = 0.0;
  skin.live(drift, 10.0, 10.0);
  EXPECT_EQ(drift.offsets()[at(3, 3)], offsets[at(3, 3)]);
  EXPECT_EQ(drift.offsets()[at(3, 4)], offsets[at(3, 4)]) << "the neighbour waits, too";
  skin.live(drift, 300.0, 10.0);
  EXPECT_NEAR(drift.offsets()[at(3, 3)], offsets[at(3, 3)], 0.1 * skin.unloaded(at(3, 3)));
}

TEST(OffsetDrift, what_reads_less_than_any_load_can_is_followed_however_far_it_is) {
  Skin skin(leaky_rubber());
  OffsetDrift drift = tracking(skin);
  skin.offset_error[at(1, 1)] = -0.6 * skin.unloaded(at(1, 1));
  const std::vector<double> excess = skin.live(drift, 180.0, 10.0);
  EXPECT_NEAR(excess[at(1, 1)], 0.0, 0.02 * skin.unloaded(at(1, 1)));
}

TEST(OffsetDrift, taxels_in_trouble_keep_their_offset_and_the_others_go_on) {
  Skin skin(leaky_rubber());
  OffsetDrift drift = tracking(skin);
  std::fill(skin.offset_error.begin(), skin.offset_error.end(), 0.05 * skin.unloaded(0));
  for (int i = 0; i < 1200; ++i) {
    ConductanceFrame& frame = skin.read(0.1);
    frame.siemens[at(0, 0)] = std::numeric_limits<double>::quiet_NaN();
    frame.taxels[at(2, 2)] = TaxelStatus::line_fault;
    frame.taxels[at(4, 4)] = TaxelStatus::saturated;
    frame.sigma_siemens[at(6, 6)] = i % 2 == 0 ? 0.0 : kSigmaSiemens;
    if (i % 7 == 0) frame.status |= FrameStatus::rejected;
    drift.process(frame);
    EXPECT_TRUE(std::isnan(frame.siemens[at(0, 0)]));
  }
  for (const std::size_t taxel : {at(0, 0), at(2, 2), at(4, 4)}) EXPECT_EQ(drift.offsets()[taxel], 0.0);
  EXPECT_NEAR(drift.offsets()[at(7, 0)], 0.05 * skin.unloaded(0), 0.01 * skin.unloaded(0));
}

TEST(OffsetDrift, a_tare_skips_taxels_that_say_nothing) {
  Skin skin;
  OffsetDrift drift(kShape, skin.calibration());
  std::fill(skin.force_n.begin(), skin.force_n.end(), 1.0);
  drift.tare();
  for (int i = 0; i < 200; ++i) {
    ConductanceFrame& frame = skin.read(0.01);
    frame.siemens[5] = std::numeric_limits<double>::quiet_NaN();
    drift.process(frame);
  }
  EXPECT_FALSE(drift.taring());
  EXPECT_EQ(drift.offsets()[5], 0.0);
  EXPECT_GT(drift.offsets()[6], 0.0);
}

TEST(OffsetDrift, clocks_may_jump) {
  Skin skin(leaky_rubber());
  OffsetDrift drift = tracking(skin);
  skin.live(drift, 30.0, 10.0);
  const std::vector<double> offsets = copy(drift.offsets());
  for (const double jump_s : {1e5, -1e5, 1e9, -1e9, 0.0}) {
    for (int i = 0; i < 5; ++i) {
      ConductanceFrame& frame = skin.read(0.1);
      frame.time += Nanos(std::llround(1e9 * jump_s));
      drift.process(frame);
    }
  }
  EXPECT_EQ(copy(drift.offsets()), offsets) << "no second was complete";
  std::fill(skin.offset_error.begin(), skin.offset_error.end(), 0.05 * skin.unloaded(0));
  skin.live(drift, 120.0, 10.0);
  EXPECT_GT(drift.offsets()[0], offsets[0] + 0.01 * skin.unloaded(0)) << "and it goes on";
}

TEST(OffsetDrift, follows_an_array_that_is_read_every_ten_seconds) {
  Skin skin(leaky_rubber());
  OffsetDrift drift = tracking(skin);
  std::fill(skin.offset_error.begin(), skin.offset_error.end(), 0.05 * skin.unloaded(0));
  EXPECT_NEAR(skin.live(drift, 600.0, 0.1)[9], 0.0, 0.02 * skin.unloaded(0));
}

TEST(OffsetDrift, frames_of_another_shape_pass) {
  OffsetDrift drift = tracking(Skin());
  ConductanceFrame frame;
  frame.siemens = {1.0, 2.0};
  drift.process(frame);
  EXPECT_EQ(frame.siemens, (std::vector<double>{1.0, 2.0}));
}

TEST(OffsetDrift, allocates_nothing) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
  Skin skin;
  OffsetDrift drift = tracking(skin);
  ConductanceFrame frame = skin.read(0.3);
  const support::AllocationGuard guard;
  for (int i = 0; i < 50; ++i) {
    if (i == 20) drift.tare();
    frame.time += std::chrono::milliseconds(300);
    drift.process(frame);
  }
  drift.reset();
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace dermis::touch::compensation
