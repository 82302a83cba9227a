// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// The scenes whose frames are all history of the material: touches and two_weights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "dermis/learn/simulation/scene.hpp"
#include "support/reference_array.hpp"

namespace dermis::learn::simulation {
namespace {

using support::reference_array;

std::vector<SceneFrame> play(std::string_view name, const ArrayDescription& array, std::uint64_t seed,
                             std::optional<std::size_t> frames, const SceneOptions& options) {
  const Scene scene = Scene::create(name, array, EnvironmentOptions{}, seed, frames, options).value();
  std::vector<SceneFrame> played(scene.frame_count());
  for (std::size_t i = 0; i < played.size(); ++i) scene.frame(i, played[i]);
  return played;
}

std::vector<SceneFrame> touches(const ArrayDescription& array, std::uint64_t seed,
                                std::optional<std::size_t> frames = {}, const SceneOptions& options = {}) {
  return play("touches", array, seed, frames, options);
}

std::vector<SceneFrame> two_weights(const ArrayDescription& array, std::uint64_t seed = 1,
                                    const SceneOptions& options = {}) {
  return play("two_weights", array, seed, {}, options);
}

double total(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(ContinuousScene, touches_come_at_the_rate_asked) {
  const ArrayDescription array = reference_array(6, 6);
  const auto slow = touches(array, 3, 500, {.rate_hz = 50.0});
  const auto usual = touches(array, 3, 1000);
  const auto fast = touches(array, 3, 2000, {.rate_hz = 200.0});
  for (std::size_t i = 0; i < slow.size(); ++i) {
    EXPECT_EQ(slow[i].hold_s, 0.02);
    EXPECT_EQ(slow[i].rest_s, 0.0);
    EXPECT_EQ(usual[2 * i].hold_s, 0.01);
    EXPECT_EQ(fast[4 * i].hold_s, 0.005);
    EXPECT_EQ(slow[i].force_n, usual[2 * i].force_n) << "the same touches at any rate";
    EXPECT_EQ(slow[i].force_n, fast[4 * i].force_n);
  }
}

TEST(ContinuousScene, a_longer_scene_of_touches_begins_with_the_shorter_one) {
  const ArrayDescription array = reference_array(6, 6);
  const auto shorter = touches(array, 4, 600);
  const auto longer = touches(array, 4, 1200);
  for (std::size_t i = 0; i < shorter.size(); ++i) EXPECT_EQ(shorter[i].force_n, longer[i].force_n);
  EXPECT_NE(touches(array, 5, 600)[599].force_n, shorter[599].force_n);
}

TEST(ContinuousScene, touches_begin_unloaded_and_stay_in_the_calibrated_range) {
  const ArrayDescription array = reference_array(16, 16);
  double heaviest_n = 0.0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto frames = touches(array, seed);
    ASSERT_EQ(frames.size(), 6000U);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].temperature_celsius, 22.0);
      if (i < 200) {
        EXPECT_EQ(total(frames[i].force_n), 0.0);
      }
      for (const double force_n : frames[i].force_n) {
        EXPECT_GE(force_n, 0.0);
        EXPECT_LE(force_n, 50.0);
        heaviest_n = std::max(heaviest_n, force_n);
      }
    }
  }
  EXPECT_GT(heaviest_n, 40.0);
}

/// Groups of loaded taxels that touch each other.
std::size_t groups_of(const std::vector<double>& force_n, std::size_t cols) {
  std::vector<bool> is_seen(force_n.size(), false);
  const auto near = [cols](std::size_t a, std::size_t b) {
    const auto apart = [](std::size_t x, std::size_t y) { return x > y ? x - y : y - x; };
    return apart(a / cols, b / cols) <= 1 && apart(a % cols, b % cols) <= 1;
  };
  std::size_t groups = 0;
  for (std::size_t first = 0; first < force_n.size(); ++first) {
    if (is_seen[first] || force_n[first] == 0.0) continue;
    ++groups;
    std::vector<std::size_t> open = {first};
    is_seen[first] = true;
    while (!open.empty()) {
      const std::size_t taxel = open.back();
      open.pop_back();
      for (std::size_t other = 0; other < force_n.size(); ++other) {
        if (is_seen[other] || force_n[other] == 0.0 || !near(taxel, other)) continue;
        is_seen[other] = true;
        open.push_back(other);
      }
    }
  }
  return groups;
}

TEST(ContinuousScene, up_to_four_touches_are_there_at_once) {
  const ArrayDescription array = reference_array(24, 24);
  std::map<std::size_t, std::size_t> frames_with;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto frames = touches(array, seed, 600, {.rate_hz = 10.0});
    for (const SceneFrame& frame : frames) ++frames_with[groups_of(frame.force_n, array.cols)];
  }
  EXPECT_LE(frames_with.rbegin()->first, 4U);
  for (const std::size_t groups : {0U, 1U, 2U, 3U}) EXPECT_GT(frames_with[groups], 20U) << groups;
}

/// What a taxel under touches goes through.
struct Life {
  std::size_t onsets = 0;
  std::size_t holds = 0;             ///< As heavy as before for 0.2 s.
  std::size_t partial_releases = 0;  ///< A hold after a heavier one, without a release between.
  std::size_t short_gaps = 0;        ///< Unloaded for at most 0.5 s.
  double longest_ramp_s = 0.0;
};

Life life_of(const std::vector<SceneFrame>& frames, std::size_t taxel) {
  Life life;
  std::size_t unloaded = frames.size();
  std::size_t same = 0;
  std::size_t changing = 0;
  double last_hold_n = 0.0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double before_n = frames[i - 1].force_n[taxel];
    const double now_n = frames[i].force_n[taxel];
    if (before_n == 0.0 && now_n > 0.0) {
      ++life.onsets;
      if (unloaded <= 50) ++life.short_gaps;
      last_hold_n = 0.0;
    }
    unloaded = now_n == 0.0 ? (before_n > 0.0 ? 1 : unloaded + 1) : unloaded;
    const bool is_same = now_n > 0.0 && std::abs(now_n - before_n) < 1e-12;
    same = is_same ? same + 1 : 0;
    changing = is_same || now_n == 0.0 ? 0 : changing + 1;
    life.longest_ramp_s = std::max(life.longest_ramp_s, 0.01 * static_cast<double>(changing));
    if (same != 18) continue;
    ++life.holds;
    if (now_n < 0.9 * last_hold_n) ++life.partial_releases;
    last_hold_n = now_n;
  }
  return life;
}

TEST(ContinuousScene, touches_rise_hold_give_way_and_return) {
  const ArrayDescription array = reference_array(12, 12);
  const auto frames = touches(array, 6, 12000);
  Life all;
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    const Life life = life_of(frames, taxel);
    all.onsets += life.onsets;
    all.holds += life.holds;
    all.partial_releases += life.partial_releases;
    all.short_gaps += life.short_gaps;
    all.longest_ramp_s = std::max(all.longest_ramp_s, life.longest_ramp_s);
  }
  EXPECT_GT(all.onsets, 100U);
  EXPECT_GT(all.holds, all.onsets);
  EXPECT_GT(all.partial_releases, all.onsets / 5);
  EXPECT_GT(all.short_gaps, all.onsets / 10);
  EXPECT_GT(all.longest_ramp_s, 0.5);
}

/// [taxels] how long each force was on each taxel [s], frames without a label left out.
std::map<std::size_t, std::map<double, double>> seconds_under_weights(const std::vector<SceneFrame>& frames) {
  std::map<std::size_t, std::map<double, double>> seconds;
  for (const SceneFrame& frame : frames) {
    const auto pressed = std::max_element(frame.force_n.begin(), frame.force_n.end());
    if (frame.loads.empty() || *pressed == 0.0) continue;
    seconds[static_cast<std::size_t>(pressed - frame.force_n.begin())][*pressed] += frame.hold_s;
  }
  return seconds;
}

TEST(ContinuousScene, two_weights_lie_on_each_of_a_few_taxels_twice) {
  const auto frames = two_weights(reference_array(5, 4));
  EXPECT_EQ(frames.size(), 50U * (10 + 4 * 2 * 55));
  const auto seconds = seconds_under_weights(frames);
  EXPECT_EQ(seconds.size(), 4U);
  for (const auto& [taxel, at] : seconds) {
    ASSERT_EQ(at.size(), 2U) << "taxel " << taxel;
    EXPECT_NEAR(at.at(5.0), 2 * 2 * (15.0 - 0.2), 1e-6);
    EXPECT_NEAR(at.at(15.0), 2 * (15.0 - 0.2), 1e-6);
  }
}

TEST(ContinuousScene, two_weights_are_stacked_unstacked_and_taken_off_without_a_label_for_the_hand) {
  const auto frames = two_weights(reference_array(3, 3), 2, {.rate_hz = 20.0, .taxels = 1});
  ASSERT_EQ(frames.size(), 20U * (10 + 2 * 55));
  std::vector<double> levels;
  double before_n = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].temperature_celsius, 22.0);
    EXPECT_EQ(frames[i].hold_s, 0.05);
    EXPECT_EQ(frames[i].rest_s, 0.0);
    const double now_n = total(frames[i].force_n);
    EXPECT_LE(std::abs(now_n - before_n), 10.0 / 4.0 + 1e-9) << "a hand takes 0.2 s";
    before_n = now_n;
    if (frames[i].loads.empty()) continue;
    EXPECT_EQ(frames[i].loads[0].value, now_n);
    if (levels.empty() || levels.back() != now_n) levels.push_back(now_n);
  }
  EXPECT_EQ(levels, (std::vector<double>{0, 5, 15, 5, 0, 5, 15, 5, 0}));
  const auto unlabelled =
      std::count_if(frames.begin(), frames.end(), [](const SceneFrame& frame) { return frame.loads.empty(); });
  EXPECT_EQ(unlabelled, 2 * 4 * 4);
}

TEST(ContinuousScene, two_weights_find_taxels_that_are_there_by_the_seed) {
  ArrayDescription array = reference_array(2, 3);
  array.absent = {1, 4};
  const auto pressed = [&](std::uint64_t seed, std::optional<std::size_t> taxels) {
    std::set<std::size_t> places;
    const SceneOptions options{.rate_hz = 10.0, .taxels = taxels};
    for (const auto& [taxel, seconds] : seconds_under_weights(two_weights(array, seed, options))) {
      places.insert(taxel);
    }
    return places;
  };
  EXPECT_EQ(pressed(1, {}), (std::set<std::size_t>{0, 2, 3, 5}));
  std::set<std::set<std::size_t>> chosen;
  for (std::uint64_t seed = 0; seed < 20; ++seed) chosen.insert(pressed(seed, 1));
  EXPECT_EQ(chosen.size(), 4U);
}

TEST(ContinuousScene, touches_leave_crossings_without_a_taxel_alone) {
  ArrayDescription array = reference_array(2, 2);
  array.absent = {2};
  for (const SceneFrame& frame : touches(array, 1, 3000)) EXPECT_EQ(frame.force_n[2], 0.0);
}

}  // namespace
}  // namespace dermis::learn::simulation
