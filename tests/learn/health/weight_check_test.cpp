// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/weight_check.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::size_t kLines = 8;
constexpr double kWeight = 5.0;
constexpr double kSigma = 0.01;  // of the force of a taxel, relative

/// An array of 8 x 8 taxels at 50 frames a second, on which an object stands on 2 x 2 taxels.
class Scale {
 public:
  Scale() : check_(support::hand_made_model(kLines, kLines), kWeight) {}
  explicit Scale(const touch::pipeline::Model& model) : check_(model, kWeight) {}

  Scale& rest(double seconds = 1.0) { return hold(0.0, seconds); }

  /// The array reads so much in all.
  Scale& hold(double newtons, double seconds) {
    for (double left = seconds; left > 0.0; left -= 0.02) add(newtons);
    return *this;
  }

  /// On its way to so much, and all of the way back.
  Scale& wave(double newtons, double seconds) {
    for (double t = 0.0; t < seconds; t += 0.02) add(newtons * (1.2 + std::sin(4.0 * t)) / 2.2);
    return *this;
  }

  [[nodiscard]] WeightFinding finding() const { return check_.finding(); }
  double sigma = kSigma;

 private:
  void add(double newtons) {
    ForceFrame force;
    force.time = time_ += std::chrono::milliseconds(20);
    force.newtons.assign(kLines * kLines, 0.0F);
    force.sigma_newtons.assign(kLines * kLines, 0.005F);
    force.signal_to_noise.assign(kLines * kLines, 0.0F);
    force.taxels.assign(kLines * kLines, TaxelStatus::ok);
    for (const std::size_t taxel : {27UL, 28UL, 35UL, 36UL}) {
      force.newtons[taxel] = static_cast<float>(newtons / 4.0 * (1.0 + 1e-3 * random_.normal()));
      if (newtons == 0.0) continue;
      force.sigma_newtons[taxel] = static_cast<float>(sigma) * force.newtons[taxel];
      force.signal_to_noise[taxel] = 500.0F;
    }
    check_.add(force);
  }

  WeightCheck check_;
  Nanos time_{};
  Random random_{1};
};

touch::pipeline::Model model_with_film() {
  touch::pipeline::Model model = support::hand_made_model(kLines, kLines);
  model.array.readout.film = Film{50e3, 2e3};
  return model;
}

/// The same array under a film that conducts so many times as much as its model says.
class ScaleWithFilm {
 public:
  explicit ScaleWithFilm(double factor)
      : film_{50e3 / factor, 2e3 / factor},
        circuit_(touch::compensation::CircuitModel::create(model_.array).value()),
        check_(model_, kWeight) {}

  /// An object that stands so with its parts on these taxels, for 3 s.
  ScaleWithFilm& put_on(const std::map<std::size_t, double>& shares) {
    add({}, 50);
    add(shares, 150);
    return *this;
  }

  ScaleWithFilm& leave(double newtons) {
    left_ = newtons;
    return *this;
  }

  WeightFinding finding() {
    add({}, 50);
    return check_.finding();
  }

 private:
  void add(const std::map<std::size_t, double>& shares, int frames) {
    ForceFrame force;
    force.newtons.assign(kLines * kLines, 0.0F);
    force.sigma_newtons.assign(kLines * kLines, 0.005F);
    force.signal_to_noise.assign(kLines * kLines, 0.0F);
    force.taxels.assign(kLines * kLines, TaxelStatus::ok);
    std::vector<double> siemens = model_.networks.unloaded.offset_siemens;
    if (left_ > 0.0) press(force, kLines * kLines - 1, left_);
    for (const auto& [taxel, share] : shares) {
      press(force, taxel, share * kWeight);
      siemens[taxel] = support::siemens_under(model_, taxel, share * kWeight, 25.0);
    }
    FilmConductances conductances(kLines, kLines);
    conductances.set(film_, std::span<const float>(force.newtons));
    circuit_.set_film(conductances);
    circuit_.solve(siemens);
    for (int k = 0; k < frames; ++k) {
      force.time = time_ += std::chrono::milliseconds(20);
      check_.add(force, circuit_.ratio());
    }
  }

  static void press(ForceFrame& force, std::size_t taxel, double newtons) {
    force.newtons[taxel] = static_cast<float>(newtons);
    force.sigma_newtons[taxel] = static_cast<float>(kSigma * newtons);
    force.signal_to_noise[taxel] = 500.0F;
  }

  touch::pipeline::Model model_ = model_with_film();
  Film film_;
  touch::compensation::CircuitModel circuit_;
  WeightCheck check_;
  Nanos time_{};
  double left_ = 0.0;
};

TEST(WeightCheck, a_film_that_conducts_more_or_less_than_its_model_says_is_found) {
  for (const double factor : {0.5, 2.0}) {
    const WeightFinding finding = ScaleWithFilm(factor).put_on({{27, 1.0}}).put_on({{45, 1.0}}).finding();
    EXPECT_TRUE(finding.has_changed_film());
    EXPECT_NEAR(finding.film_factor, factor, 0.05 * factor);
    EXPECT_NE(describe(finding).find("recalibrate: the film between the lines has changed: it conducts about " +
                                     std::string(factor > 1.0 ? "100 % more" : "50 % less")),
              std::string::npos)
        << describe(finding);
  }
}

TEST(WeightCheck, a_film_that_has_not_changed_or_is_seen_once_or_at_the_rim_only_says_nothing) {
  EXPECT_FALSE(ScaleWithFilm(1.1).put_on({{27, 1.0}}).put_on({{45, 1.0}}).finding().has_changed_film());
  EXPECT_FALSE(ScaleWithFilm(2.0).put_on({{27, 1.0}}).finding().has_changed_film());
  EXPECT_FALSE(ScaleWithFilm(2.0).put_on({{24, 1.0}}).put_on({{3, 1.0}}).finding().has_changed_film());
}

TEST(WeightCheck, an_object_larger_than_a_taxel_is_no_film) {
  for (const double beside : {0.01, 0.03, 0.1, 0.15}) {
    const double middle = 1.0 - 4.0 * beside;
    ScaleWithFilm scale(1.0);
    for (const std::size_t taxel : {27UL, 45UL, 18UL}) {
      scale.put_on(
          {{taxel, middle}, {taxel - 1, beside}, {taxel + 1, beside}, {taxel - 8, beside}, {taxel + 8, beside}});
    }
    EXPECT_FALSE(scale.finding().has_changed_film()) << beside;
  }
}

TEST(WeightCheck, forces_that_a_changed_film_leaves_behind_do_not_join_presses) {
  ScaleWithFilm scale(2.0);
  scale.leave(0.2 * kWeight).put_on({{27, 1.0}}).put_on({{45, 1.0}}).put_on({{18, 1.0}});
  const WeightFinding finding = scale.finding();
  EXPECT_EQ(finding.presses.size(), 3U);
  EXPECT_TRUE(finding.has_changed_film());
}

TEST(WeightCheck, an_object_that_reads_what_it_weighs_is_well) {
  const WeightFinding finding = Scale().rest().hold(4.94, 4.0).rest().finding();
  ASSERT_EQ(finding.presses.size(), 1U);
  EXPECT_NEAR(finding.presses.front().newtons, 4.94, 0.01);
  EXPECT_NEAR(finding.ratio, 0.988, 0.002);
  EXPECT_NEAR(finding.sigma, kSigma / 2.0, 1e-4);  // four taxels
  EXPECT_FALSE(finding.has_aged());
  EXPECT_EQ(describe(finding),
            "weight  5 N, put on once\nreads   4.94 N (4.94 N)\nwell: reads 1.2 % low, within 3 %\n");
}

TEST(WeightCheck, what_is_narrower_than_a_point_was_shows_a_cover_that_spreads_less) {
  touch::pipeline::Model model = support::hand_made_model(kLines, kLines);
  model.array.cover = Cover{0.010, {}};
  const WeightFinding finding = Scale(model).rest().hold(kWeight, 3.0).rest().finding();
  EXPECT_TRUE(finding.has_lost_cover());
  EXPECT_NE(describe(finding).find("recalibrate: the cover has changed, it spreads less"), std::string::npos);
}

TEST(WeightCheck, what_is_as_wide_as_a_point_was_says_nothing_of_the_cover) {
  touch::pipeline::Model model = support::hand_made_model(kLines, kLines);
  model.array.cover = Cover{0.0035, {}};
  const WeightFinding finding = Scale(model).rest().hold(kWeight, 3.0).rest().finding();
  EXPECT_FALSE(finding.has_lost_cover());
  EXPECT_EQ(describe(finding).find("cover"), std::string::npos);
}

TEST(WeightCheck, a_gain_that_has_changed_by_a_tenth_is_found_by_one_press) {
  for (const double change : {0.9, 1.1}) {
    const WeightFinding finding = Scale().rest().hold(change * kWeight, 4.0).rest().finding();
    EXPECT_TRUE(finding.has_aged());
    EXPECT_NE(describe(finding).find("recalibrate: gains have changed by about 10 % (\u00b1 1 %): it reads " +
                                     std::string(change > 1.0 ? "too much" : "too little")),
              std::string::npos)
        << describe(finding);
  }
}

TEST(WeightCheck, a_model_that_is_less_sure_needs_more_presses) {
  Scale scale;
  scale.sigma = 0.12;
  scale.rest().hold(1.1 * kWeight, 4.0).rest();
  EXPECT_FALSE(scale.finding().has_aged());
  EXPECT_NE(describe(scale.finding()).find("no change seen: reads 10.0 % high, within 18 %: put the object on again"),
            std::string::npos)
      << describe(scale.finding());
  for (int k = 0; k < 4; ++k) scale.hold(1.1 * kWeight, 4.0).rest();
  EXPECT_TRUE(scale.finding().has_aged());
}

TEST(WeightCheck, presses_that_differ_by_more_than_the_model_says_make_it_less_sure) {
  Scale scale;
  for (const double reads : {4.0, 5.0, 6.0, 6.8}) scale.rest().hold(reads, 4.0);
  const WeightFinding finding = scale.rest().finding();
  EXPECT_EQ(finding.presses.size(), 4U);
  EXPECT_GT(finding.sigma, 0.08);
  EXPECT_FALSE(finding.has_aged());
}

TEST(WeightCheck, the_hand_that_puts_it_on_does_not_count) {
  const WeightFinding finding = Scale().rest().hold(9.0, 0.9).hold(5.0, 4.0).hold(7.0, 0.5).rest().finding();
  ASSERT_EQ(finding.presses.size(), 1U);
  EXPECT_NEAR(finding.ratio, 1.0, 0.01);
}

TEST(WeightCheck, what_is_no_steady_press_of_the_weight_is_counted_apart) {
  const WeightFinding finding =
      Scale().rest().hold(5.0, 0.8).rest().wave(5.0, 4.0).rest().hold(20.0, 4.0).rest().finding();
  EXPECT_TRUE(finding.presses.empty());
  EXPECT_EQ(finding.unsteady, 2U);
  EXPECT_EQ(finding.others, 1U);
  EXPECT_FALSE(finding.has_aged());
  EXPECT_NE(describe(finding).find("1 read something else"), std::string::npos);
}

TEST(WeightCheck, the_weight_may_be_one_of_several_that_are_stacked) {
  const WeightFinding finding = Scale().rest().hold(15.0, 4.0).hold(5.1, 4.0).hold(15.0, 4.0).rest().finding();
  ASSERT_EQ(finding.presses.size(), 1U);
  EXPECT_NEAR(finding.ratio, 1.02, 0.002);
}

TEST(WeightCheck, says_what_is_missing) {
  EXPECT_EQ(describe(Scale().rest().finding()), "nothing was put on");
  EXPECT_NE(describe(Scale().rest().hold(5.0, 1.0).rest().finding()).find("lay still"), std::string::npos);
}

TEST(WeightCheck, a_press_that_lasts_counts) {
  EXPECT_EQ(Scale().rest().hold(5.0, 3.0).finding().presses.size(), 1U);
}

TEST(WeightCheck, a_force_without_an_upper_bound_weighs_nothing) {
  Scale scale;
  scale.sigma = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(scale.rest().hold(5.0, 4.0).rest().finding().presses.empty());
}

}  // namespace
}  // namespace dermis::learn::health
