// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <vector>

#include "support/reference_array.hpp"

namespace dermis::learn::simulation {
namespace {

using support::reference_array;

std::vector<SceneFrame> play(std::string_view name, const ArrayDescription& array, std::uint64_t seed = 1,
                             std::optional<std::size_t> frames = {}) {
  const Scene scene = Scene::create(name, array, EnvironmentOptions{}, seed, frames).value();
  std::vector<SceneFrame> played(scene.frame_count());
  for (std::size_t i = 0; i < played.size(); ++i) scene.frame(i, played[i]);
  return played;
}

double total(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(Scene, labels_of_every_frame_state_its_forces) {
  const ArrayDescription array = reference_array(5, 4);
  for (const SceneKind& kind : scene_kinds()) {
    const std::string name = kind.name;
    const auto frames = play(kind.name, array);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (frames[i].loads.empty()) {
        ASSERT_EQ(name, "two_weights") << "all others say what presses in every frame";
        continue;
      }
      std::vector<double> labelled(array.taxel_count(), 0.0);
      for (const Load& load : frames[i].loads) {
        EXPECT_EQ(load.frame, i);
        const double on_each = load.kind == LoadKind::pressure ? load.value * *array.taxel_area_m2 : load.value;
        for (const std::size_t taxel : taxel_indices(load.where, array.cols)) labelled[taxel] = on_each;
      }
      EXPECT_EQ(labelled, frames[i].force_n) << name << " frame " << i;
    }
  }
}

TEST(Scene, supply_stays_within_ten_percent) {
  const auto frames = play("multitouch", reference_array(4, 4));
  const auto [low, high] = std::minmax_element(frames.begin(), frames.end(),
                                               [](const auto& a, const auto& b) { return a.supply_v < b.supply_v; });
  EXPECT_GE(low->supply_v, 4.5);
  EXPECT_LT(low->supply_v, 4.51);
  EXPECT_LE(high->supply_v, 5.5);
  EXPECT_GT(high->supply_v, 5.49);
}

TEST(Scene, calibration_presses_each_taxel_alone_at_every_force_and_temperature) {
  const ArrayDescription array = reference_array(3, 4);
  const auto frames = play("calibration", array);
  EXPECT_EQ(frames.size(), 5 * (20 + 14 * 12));
  std::map<std::pair<double, std::size_t>, std::vector<double>> presses;
  std::map<double, int> unloaded;
  for (const SceneFrame& frame : frames) {
    const auto loaded = std::count_if(frame.force_n.begin(), frame.force_n.end(), [](double n) { return n > 0.0; });
    ASSERT_LE(loaded, 1);
    if (loaded == 0) {
      ++unloaded[frame.temperature_celsius];
      continue;
    }
    const auto pressed = std::max_element(frame.force_n.begin(), frame.force_n.end());
    const auto taxel = static_cast<std::size_t>(pressed - frame.force_n.begin());
    presses[{frame.temperature_celsius, taxel}].push_back(*pressed);
    EXPECT_EQ(frame.hold_s, 1.0);
    EXPECT_GE(frame.rest_s, 1.0);
  }
  EXPECT_EQ(unloaded, (std::map<double, int>{{0.0, 20}, {12.5, 20}, {25.0, 20}, {37.5, 20}, {50.0, 20}}));
  EXPECT_EQ(presses.size(), 5U * 12U);
  for (const auto& [where, forces_n] : presses) {
    ASSERT_EQ(forces_n.size(), 14U);
    EXPECT_EQ(forces_n.front(), 0.5);
    EXPECT_EQ(forces_n.back(), 50.0);
    for (std::size_t i = 1; i < 14; ++i) EXPECT_NEAR(forces_n[i] / forces_n[i - 1], std::pow(100.0, 1.0 / 13.0), 1e-12);
  }
}

TEST(Scene, calibration_of_the_reference_array_has_17920_presses) {
  const Scene scene = Scene::create("calibration", reference_array(16, 16), EnvironmentOptions{}, 1).value();
  EXPECT_EQ(scene.frame_count(), 17'920U + 100U);
}

TEST(Scene, paper_calibration_is_the_calibration_at_20_celsius) {
  const ArrayDescription array = reference_array(3, 4);
  const auto frames = play("paper_calibration", array);
  const auto all_temperatures = play("calibration", array);
  ASSERT_EQ(frames.size(), 20 + 14 * 12);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].temperature_celsius, 20.0);
    EXPECT_EQ(frames[i].force_n, all_temperatures[i].force_n);
  }
}

TEST(Scene, uniform_labels_pressure_on_all_taxels) {
  const ArrayDescription array = reference_array(3, 3);
  const auto frames = play("uniform", array);
  EXPECT_EQ(frames.size(), 5U * (20 + 70));
  std::set<double> levels;
  for (const SceneFrame& frame : frames) {
    ASSERT_EQ(frame.loads.size(), 1U);
    EXPECT_EQ(frame.loads[0].where, all_taxels(array));
    if (frame.loads[0].kind == LoadKind::pressure) {
      levels.insert(frame.loads[0].value);
    } else {
      EXPECT_EQ(total(frame.force_n), 0.0);
    }
  }
  EXPECT_EQ(levels.size(), 14U);
  EXPECT_EQ(*levels.begin(), 15e3);
  EXPECT_EQ(*levels.rbegin(), 700e3);
}

TEST(Scene, paper_presses_sixteen_different_taxels_at_each_force) {
  const auto frames = play("paper", reference_array(16, 16));
  ASSERT_EQ(frames.size(), 48U);
  std::map<double, std::set<std::size_t>> taxels;
  for (const SceneFrame& frame : frames) {
    ASSERT_EQ(frame.loads.size(), 1U);
    EXPECT_EQ(frame.temperature_celsius, 20.0);
    taxels[frame.loads[0].value].insert(16 * frame.loads[0].where.first_row + frame.loads[0].where.first_col);
  }
  ASSERT_EQ(taxels.size(), 3U);
  for (const double force_n : {10.0, 20.0, 50.0}) EXPECT_EQ(taxels[force_n].size(), 16U);
  EXPECT_NE(taxels[10.0], taxels[20.0]);
}

TEST(Scene, multitouch_stays_in_the_calibrated_range) {
  const auto frames = play("multitouch", reference_array(16, 16));
  ASSERT_EQ(frames.size(), 1000U);
  std::size_t on_one_taxel = 0;
  for (const SceneFrame& frame : frames) {
    EXPECT_GE(frame.temperature_celsius, 0.0);
    EXPECT_LT(frame.temperature_celsius, 50.0);
    EXPECT_GT(total(frame.force_n), 0.0);
    for (const double force_n : frame.force_n) {
      EXPECT_LE(force_n, 50.0);
      EXPECT_TRUE(force_n == 0.0 || force_n >= 0.02);
    }
    if (frame.loads.size() == 1) ++on_one_taxel;
  }
  // One contact (1/4) on a single taxel (0.4), or up to four on the same one (rare): about 10 %.
  EXPECT_NEAR(static_cast<double>(on_one_taxel) / 1000.0, 0.1, 5.0 * std::sqrt(0.1 * 0.9 / 1000.0));
}

double pressure(const AppliedContact& contact, double away_m) {
  const double radius_m = 0.5 * contact.diameter_m;
  if (away_m >= radius_m) return 0.0;
  const double mean = contact.force_n / (std::numbers::pi * radius_m * radius_m);
  const double rho = away_m / radius_m;
  return contact.shape == PatchShape::flat ? mean : 1.5 * mean * std::sqrt(1.0 - rho * rho);
}

/// Pressure summed over small squares of the disc of a taxel.
double summed_force(const std::vector<AppliedContact>& contacts, double x_m, double y_m, double disc_radius_m) {
  constexpr int kSquares = 80;
  const double side_m = 2.0 * disc_radius_m / kSquares;
  double sum_n = 0.0;
  for (int i = 0; i < kSquares; ++i) {
    for (int j = 0; j < kSquares; ++j) {
      const double dx = (i + 0.5) * side_m - disc_radius_m;
      const double dy = (j + 0.5) * side_m - disc_radius_m;
      if (std::hypot(dx, dy) > disc_radius_m) continue;
      for (const AppliedContact& contact : contacts) {
        sum_n += side_m * side_m * pressure(contact, std::hypot(x_m + dx - contact.x_m, y_m + dy - contact.y_m));
      }
    }
  }
  return sum_n;
}

TEST(Scene, contacts_press_on_taxels_what_lies_on_their_discs) {
  ArrayDescription array = reference_array(16, 16);
  array.col_pitch_m = 0.008;
  const double radius_m = std::sqrt(*array.taxel_area_m2 / std::numbers::pi);
  const auto frames = play("contacts", array, 3);
  for (std::size_t i = 60; i < frames.size(); i += 400) {
    double on_taxels_n = 0.0;
    for (const AppliedContact& contact : frames[i].contacts) on_taxels_n += contact.taxel_force_n;
    EXPECT_NEAR(on_taxels_n, total(frames[i].force_n), 1e-9);
    for (std::size_t row = 0; row < 16; ++row) {
      for (std::size_t col = 0; col < 16; ++col) {
        const double x_m = 0.008 * static_cast<double>(col);
        const double y_m = 0.010 * static_cast<double>(row);
        const double expected_n = summed_force(frames[i].contacts, x_m, y_m, radius_m);
        EXPECT_NEAR(frames[i].force_n[array.index(row, col)], expected_n, 0.006 * expected_n + 0.02) << "frame " << i;
      }
    }
  }
}

TEST(Scene, a_disc_that_covers_a_patch_carries_its_whole_force) {
  ArrayDescription array = reference_array(1, 1);
  array.taxel_area_m2 = 0.01;
  for (const SceneFrame& frame : play("contacts", array)) {
    for (const AppliedContact& contact : frame.contacts) {
      EXPECT_NEAR(contact.taxel_force_n, contact.force_n, 1e-12 * contact.force_n);
    }
  }
}

TEST(Scene, contacts_stay_apart_inside_the_array_and_within_their_ranges) {
  const ArrayDescription array = reference_array(16, 16);
  std::set<std::size_t> counts;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    for (const SceneFrame& frame : play("contacts", array, seed)) {
      counts.insert(frame.contacts.size());
      EXPECT_EQ(frame.hold_s, 0.01);
      EXPECT_GE(frame.temperature_celsius, 0.0);
      EXPECT_LE(frame.temperature_celsius, 50.0);
      for (const AppliedContact& contact : frame.contacts) {
        EXPECT_GE(contact.diameter_m, 0.008);
        EXPECT_LT(contact.diameter_m, 0.030);
        EXPECT_GT(contact.force_n, 0.0);
        EXPECT_LE(contact.force_n, 50.0);
        EXPECT_LE(contact.taxel_force_n, contact.force_n);
        for (const double along : {contact.x_m, contact.y_m}) EXPECT_LE(std::abs(along - 0.075), 0.080 + 1e-9);
        for (const AppliedContact& other : frame.contacts) {
          if (other.id == contact.id) continue;
          const double apart_m = std::hypot(contact.x_m - other.x_m, contact.y_m - other.y_m);
          EXPECT_GE(apart_m, std::max(0.025, 0.5 * (contact.diameter_m + other.diameter_m) + 0.010));
        }
      }
    }
  }
  EXPECT_EQ(counts, (std::set<std::size_t>{0, 1, 2, 3, 4, 5}));
}

TEST(Scene, contacts_come_move_smoothly_and_go) {
  const ArrayDescription array = reference_array(16, 16);
  const auto frames = play("contacts", array, 7);
  ASSERT_EQ(frames.size(), 2000U);
  std::map<std::uint32_t, std::vector<std::pair<std::size_t, AppliedContact>>> lives;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (const AppliedContact& contact : frames[i].contacts) lives[contact.id].emplace_back(i, contact);
  }
  EXPECT_GE(lives.size(), 10U);
  EXPECT_EQ(lives.begin()->first, 1U);
  EXPECT_EQ(lives.rbegin()->first, lives.size());
  double farthest_m = 0.0;
  for (const auto& [id, life] : lives) {
    EXPECT_GE(life.size(), 50U);
    EXPECT_GE(life.front().first, 30U);
    EXPECT_LE(life.back().first, 1969U);
    for (std::size_t k = 1; k < life.size(); ++k) {
      EXPECT_EQ(life[k].first, life[k - 1].first + 1) << "a contact has one life";
      const double step_m =
          std::hypot(life[k].second.x_m - life[k - 1].second.x_m, life[k].second.y_m - life[k - 1].second.y_m);
      EXPECT_LT(step_m, 0.01 * 0.25) << "faster than 0.25 m/s";
    }
    const AppliedContact& first = life.front().second;
    const AppliedContact& last = life.back().second;
    farthest_m = std::max(farthest_m, std::hypot(first.x_m - last.x_m, first.y_m - last.y_m));
    EXPECT_LT(first.force_n, 0.15 * life[life.size() / 2].second.force_n);
    EXPECT_LT(last.force_n, 0.15 * life[life.size() / 2].second.force_n);
  }
  EXPECT_GT(farthest_m, 0.03);
}

TEST(Scene, contacts_follow_the_seed_and_the_length_asked) {
  const ArrayDescription array = reference_array(16, 16);
  const auto frames = play("contacts", array, 5, 400);
  ASSERT_EQ(frames.size(), 400U);
  ASSERT_FALSE(frames[100].contacts.empty());
  EXPECT_EQ(play("contacts", array, 5, 400)[100].contacts, frames[100].contacts);
  EXPECT_NE(play("contacts", array, 6, 400)[100].contacts, frames[100].contacts);
  EXPECT_EQ(play("multitouch", array, 5, 10)[3].contacts.size(), 0U);
}

TEST(Scene, idle_warms_up_and_cools_down_unloaded) {
  const auto frames = play("idle", reference_array(2, 2), 1, 100);
  ASSERT_EQ(frames.size(), 100U);
  EXPECT_EQ(frames[0].temperature_celsius, 0.0);
  EXPECT_NEAR(frames[50].temperature_celsius, 50.0, 1e-12);
  EXPECT_NEAR(frames[25].temperature_celsius, frames[75].temperature_celsius, 1e-9);
  for (const SceneFrame& frame : frames) EXPECT_EQ(total(frame.force_n), 0.0);
}

TEST(Scene, frames_depend_on_seed_and_index_alone) {
  const ArrayDescription array = reference_array(6, 6);
  const auto frames = play("multitouch", array, 5, 50);
  const Scene longer = Scene::create("multitouch", array, EnvironmentOptions{}, 5, 500).value();
  SceneFrame frame;
  longer.frame(31, frame);
  EXPECT_EQ(frame.force_n, frames[31].force_n);
  EXPECT_EQ(frame.supply_v, frames[31].supply_v);
  EXPECT_NE(play("multitouch", array, 6, 50)[31].force_n, frames[31].force_n);
}

TEST(Scene, a_calibration_of_many_taxels_is_as_long_as_it_needs) {
  const Scene scene = Scene::create("calibration", reference_array(64, 64), EnvironmentOptions{}, 1).value();
  EXPECT_EQ(scene.frame_count(), 5U * (20U + 14U * 4096U));
}

TEST(Scene, a_field_presses_as_given_but_where_no_taxel_is) {
  ArrayDescription array = reference_array(2, 2);
  array.absent = {3};
  const SceneOptions options{.field_n = {0.0F, 1.5F, 0.0F, 2.0F, 3.0F, 0.0F, 0.0F, 4.0F}};
  const Scene scene = Scene::create("field", array, EnvironmentOptions{}, 1, {}, options).value();
  ASSERT_EQ(scene.frame_count(), 2U);
  SceneFrame frame;
  scene.frame(0, frame);
  EXPECT_EQ(frame.force_n, (std::vector{0.0, 1.5, 0.0, 0.0}));
  EXPECT_EQ(frame.hold_s, 0.01);
  scene.frame(1, frame);
  EXPECT_EQ(frame.force_n, (std::vector{3.0, 0.0, 0.0, 0.0}));
}

TEST(Scene, refuses_what_it_cannot_play) {
  ArrayDescription array = reference_array(3, 3);
  const auto message = [&](std::string_view name, std::optional<std::size_t> frames = {}) {
    return Scene::create(name, array, EnvironmentOptions{}, 1, frames).error().message;
  };
  EXPECT_NE(message("nap").find(
                "calibration, uniform, paper_calibration, paper, multitouch, contacts, idle, touches, two_weights"),
            std::string::npos);
  EXPECT_NE(message("paper").find("at least 16 taxels"), std::string::npos);
  EXPECT_NE(message("calibration", 10).find("fixed number"), std::string::npos);
  EXPECT_NE(message("idle", 0).find("needs 1 to 200000 frames"), std::string::npos);
  EXPECT_NE(message("two_weights", 10).find("fixed number"), std::string::npos);
  const auto refusal = [&](std::string_view name, const SceneOptions& options) {
    return Scene::create(name, array, EnvironmentOptions{}, 1, {}, options).error().message;
  };
  EXPECT_EQ(refusal("contacts", {.rate_hz = 50.0}), "scene \"contacts\": has a rate of its own");
  EXPECT_EQ(refusal("touches", {.taxels = 2}), "scene \"touches\": has taxels of its own");
  EXPECT_EQ(refusal("touches", {.rate_hz = 9.0}), "scene \"touches\": needs 10 to 1000 frames a second");
  EXPECT_EQ(refusal("touches", {.rate_hz = std::nan("")}), "scene \"touches\": needs 10 to 1000 frames a second");
  EXPECT_EQ(refusal("two_weights", {.taxels = 0}), "scene \"two_weights\": needs 1 to 9 taxels");
  EXPECT_EQ(refusal("two_weights", {.taxels = 10}), "scene \"two_weights\": needs 1 to 9 taxels");
  EXPECT_NE(refusal("two_weights", {.rate_hz = 1000.0}).find("ask for fewer taxels or fewer frames a second"),
            std::string::npos);
  const std::string unfit = "scene \"field\": needs the forces of 9 taxels a frame";
  EXPECT_EQ(refusal("field", {}), unfit);
  EXPECT_EQ(refusal("field", {.field_n = std::vector<float>(10)}), unfit);
  std::vector<float> below(18);
  below[11] = -1.0F;
  EXPECT_EQ(refusal("field", {.field_n = below}),
            "scene \"field\": frame 1, taxel 2: -1.000000 is no force of 0 to 10000 N");
  array.taxel_area_m2.reset();
  EXPECT_NE(message("uniform").find("array.taxel_area_mm2"), std::string::npos);
  EnvironmentOptions environment;
  environment.supply_variation = 0.9;
  EXPECT_EQ(Scene::create("idle", array, environment, 1).error().message.find("environment.supply_variation:"), 0U);
}

}  // namespace
}  // namespace dermis::learn::simulation
