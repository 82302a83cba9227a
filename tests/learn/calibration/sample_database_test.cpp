// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/sample_database.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "learn/calibration/labels/flicker.hpp"
#include "learn/calibration/simulated.hpp"

namespace dermis::learn::calibration {
namespace {

ArrayDescription bare_array() {
  ArrayDescription array;
  array.rows = 2;
  array.cols = 3;
  array.taxel_area_m2 = 1e-4;
  array.readout.circuit = Circuit::none;
  array.readout.adc_bits = 10;
  return array;
}

std::vector<RawFrame> frames_of(std::size_t count) {
  std::vector<RawFrame> frames(count);
  for (std::size_t k = 0; k < count; ++k) {
    frames[k].time = std::chrono::seconds(k);
    frames[k].counts.assign(6, static_cast<float>(100 * k));
  }
  return frames;
}

constexpr TaxelRegion kAll{0, 0, 1, 2};

TEST(SampleDatabase, keeps_labelled_frames_and_what_their_loads_tell) {
  const std::vector<Load> loads = {{0, LoadKind::force, kAll, 0.0},
                                   {1, LoadKind::force, {0, 1, 0, 1}, 5.0},
                                   {3, LoadKind::force, {0, 0, 1, 0}, 8.0},
                                   {4, LoadKind::pressure, {1, 0, 1, 2}, 2e4}};
  const Result<SampleDatabase> database = build_sample_database(bare_array(), frames_of(6), loads);
  ASSERT_TRUE(database) << database.error().message;
  ASSERT_EQ(database->samples.size(), 4U);  // frames 2 and 5 are unlabelled
  EXPECT_TRUE(database->samples[0].unloaded);

  const Sample& press = database->samples[1];
  EXPECT_FALSE(press.unloaded);
  EXPECT_EQ(press.known_newtons, (std::vector<float>{0, 5, 0, 0, 0, 0}));
  EXPECT_NEAR(press.siemens[0], 100.0 / 1023.0, 1e-8);

  const Sample& shared = database->samples[2];
  EXPECT_TRUE(std::isnan(shared.known_newtons[0]) && std::isnan(shared.known_newtons[3]));
  EXPECT_EQ(shared.known_newtons[1], 0.0F);
  ASSERT_EQ(shared.totals.size(), 1U);
  EXPECT_EQ(shared.totals[0].taxels, (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(shared.totals[0].newtons, 8.0);

  const Sample& bladder = database->samples[3];
  EXPECT_EQ(bladder.known_newtons, (std::vector<float>{0, 0, 0, 2, 2, 2}));  // 20 kPa on 1 cm2
  EXPECT_TRUE(bladder.totals.empty());
}

TEST(SampleDatabase, leaves_out_what_comes_before_settling) {
  const std::vector<Load> loads = {{1, LoadKind::force, kAll, 0.0}, {4, LoadKind::force, kAll, 0.0}};
  const auto database = build_sample_database(bare_array(), frames_of(6), loads, std::chrono::seconds(2));
  ASSERT_TRUE(database);
  ASSERT_EQ(database->samples.size(), 1U);
  EXPECT_NEAR(database->samples[0].siemens[0], 400.0 / 1023.0, 1e-7);
}

TEST(SampleDatabase, asks_for_an_unloaded_frame) {
  const auto database =
      build_sample_database(bare_array(), frames_of(2), std::vector<Load>{{1, LoadKind::force, kAll, 3.0}});
  ASSERT_FALSE(database);
  EXPECT_EQ(database.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(database.error().message,
            "the loads name no unloaded frame: record a few frames with nothing on the array and label them "
            "'<frame>,force,all,0'");
}

TEST(SampleDatabase, refuses_loads_that_cannot_be_used) {
  ArrayDescription array = bare_array();
  EXPECT_EQ(build_sample_database(array, frames_of(2), {}).error().message,
            "the loads name no frame: known loads are needed");
  EXPECT_EQ(
      build_sample_database(array, frames_of(2), std::vector<Load>{{2, LoadKind::force, kAll, 0.0}}).error().message,
      "a load names frame 2, there are 2 (counted from 0)");
  array.taxel_area_m2.reset();
  EXPECT_EQ(
      build_sample_database(array, frames_of(2), std::vector<Load>{{1, LoadKind::pressure, kAll, 1.0}}).error().message,
      "loads given as pressure need array.taxel_area_mm2");
}

TEST(SampleDatabase, counts_rejected_frames_and_refuses_many_of_them) {
  std::vector<RawFrame> frames = frames_of(10);
  std::vector<Load> loads;
  for (std::size_t k = 0; k < 40; ++k) {
    if (k >= 10) {
      frames.push_back(frames.back());
      frames.back().counts.assign(6, 1.0F);
    }
    loads.push_back({k, LoadKind::force, kAll, 0.0});
  }
  frames[5].supply_v = -1.0;
  frames[7].counts.assign(6, std::nanf(""));
  const auto few = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(few);
  EXPECT_EQ(few->samples.size(), 38U);
  EXPECT_EQ(few->frames_rejected, 2U);
  EXPECT_EQ(few->first_rejection, "frame 5: a supply of 0 V or less");

  for (std::size_t k = 20; k < 25; ++k) frames[k].counts.pop_back();
  const auto many = build_sample_database(bare_array(), frames, loads);
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().message,
            "7 of 40 labelled frames cannot be used: the first is frame 5: a supply of 0 V or less");
}

TEST(SampleDatabase, does_not_trust_a_saturated_reading) {
  std::vector<RawFrame> frames = frames_of(2);
  frames[1].counts[4] = 1023.0F;
  const std::vector<Load> loads = {{0, LoadKind::force, kAll, 0.0}, {1, LoadKind::force, {1, 1, 1, 1}, 90.0}};
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database);
  EXPECT_TRUE(std::isnan(database->samples[1].known_newtons[4]));
}

TEST(SampleDatabase, removes_crosstalk_and_supply) {
  const ArrayDescription array = reference_array(6, 5);
  auto simulator = simulate(array, "multitouch", 3, {}, 20);
  Recording recording;
  std::vector<std::vector<double>> truth;
  RawFrame frame;
  while (simulator->next(frame).value()) {
    recording.frames.push_back(frame);
    recording.loads.insert(recording.loads.end(), simulator->loads().begin(), simulator->loads().end());
    truth.push_back(simulator->true_siemens());
  }
  Recording idle = record(array, "idle", 4, {}, 1);
  idle.frames[0].time = recording.frames.back().time;
  recording.frames.push_back(idle.frames[0]);
  recording.loads.push_back({recording.frames.size() - 1, LoadKind::force, all_taxels(array), 0.0});
  const auto database = build_sample_database(array, recording.frames, recording.loads);
  ASSERT_TRUE(database) << database.error().message;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    for (std::size_t taxel = 0; taxel < truth[k].size(); ++taxel) {
      // 1 LSB of noise and 0.1 % of the supply meter, amplified by crosstalk.
      EXPECT_NEAR(database->samples[k].siemens[taxel], truth[k][taxel], 0.05 * truth[k][taxel] + 3e-5);
    }
  }
}

TEST(SampleDatabase, knows_the_supplies_of_its_frames_without_outliers) {
  std::vector<RawFrame> frames = frames_of(400);
  std::vector<Load> loads;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    frames[k].counts.assign(6, 100.0F);
    frames[k].supply_v = 4.8 + 0.001 * static_cast<double>(k);
    loads.push_back({k, LoadKind::force, kAll, 0.0});
  }
  frames[7].supply_v = 12.0;
  frames[8].supply_v.reset();
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database) << database.error().message;
  ASSERT_TRUE(database->supply);
  EXPECT_NEAR(database->supply->least_v, 4.8, 0.005);
  EXPECT_NEAR(database->supply->most_v, 5.2, 0.005);
  for (RawFrame& frame : frames) frame.supply_v.reset();
  EXPECT_FALSE(build_sample_database(bare_array(), frames, loads)->supply);
}

TEST(SampleDatabase, drops_a_total_that_a_saturated_taxel_makes_incomplete) {
  std::vector<RawFrame> frames = frames_of(3);
  frames[1].counts[0] = 1023.0F;
  const std::vector<Load> loads = {
      {0, LoadKind::force, kAll, 0.0}, {1, LoadKind::force, kAll, 50.0}, {2, LoadKind::force, kAll, 20.0}};
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database);
  EXPECT_TRUE(database->samples[1].totals.empty());
  EXPECT_EQ(database->samples[2].totals.size(), 1U);
}

TEST(SampleDatabase, leaves_out_the_few_frames_without_a_temperature) {
  std::vector<RawFrame> frames = frames_of(20);
  std::vector<Load> loads;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    frames[k].counts.assign(6, 1.0F);
    if (k != 7) frames[k].temperature_celsius = 20.0 + static_cast<double>(k);
    loads.push_back({k, LoadKind::force, kAll, 0.0});
  }
  const auto few = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(few);
  EXPECT_EQ(few->samples.size(), 19U);
  EXPECT_EQ(few->first_rejection, "frame 7: no temperature, where most frames have one");

  for (std::size_t k = 0; k < 10; ++k) frames[k].temperature_celsius.reset();
  const auto many = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(many);
  EXPECT_EQ(many->samples.size(), 20U);
}

TEST(SampleDatabase, a_missing_reading_costs_its_taxel_alone_and_is_named) {
  std::vector<RawFrame> frames = frames_of(3);
  for (RawFrame& frame : frames) frame.counts[2] = std::nanf("");
  frames[1].counts[4] = 5000.0F;
  const std::vector<Load> loads = {
      {0, LoadKind::force, kAll, 0.0}, {1, LoadKind::pressure, kAll, 2e4}, {2, LoadKind::force, kAll, 20.0}};
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database) << database.error().message;
  ASSERT_EQ(database->samples.size(), 3U);
  const std::vector<float>& newtons = database->samples[1].known_newtons;
  for (std::size_t taxel = 0; taxel < 6; ++taxel) {
    EXPECT_EQ(std::isnan(newtons[taxel]), taxel == 2 || taxel == 4) << taxel;
    EXPECT_TRUE(std::isfinite(database->samples[1].siemens[taxel])) << taxel;
    EXPECT_TRUE(std::isfinite(database->samples[1].ratio[taxel])) << taxel;
    const bool has_reading = taxel != 2 && taxel != 4;
    EXPECT_NEAR(bare_reading(*database, database->samples[1], taxel),
                has_reading ? double{frames[1].counts[taxel]} / 1023.0 : 0.0, 1e-7);
  }
  EXPECT_EQ(database->samples[2].totals.size(), 1U);
  ASSERT_EQ(database->remarks.size(), 1U);
  EXPECT_EQ(database->remarks[0],
            "no reading (not a number, or outside the ADC) of r0c2 in 3, r1c1 in 1 of 3 frames with a label: left out");
}

TEST(SampleDatabase, taxels_that_the_sheet_does_not_have_carry_nothing) {
  ArrayDescription array = bare_array();
  array.absent = {0, 4};
  const std::vector<Load> loads = {
      {0, LoadKind::force, kAll, 0.0}, {1, LoadKind::pressure, kAll, 2e4}, {2, LoadKind::force, kAll, 20.0}};
  const auto database = build_sample_database(array, frames_of(3), loads);
  ASSERT_TRUE(database) << database.error().message;
  EXPECT_TRUE(std::isnan(database->samples[1].known_newtons[0]));
  EXPECT_EQ(database->samples[1].known_newtons[1], 2.0F);
  EXPECT_EQ(database->samples[2].totals[0].taxels, (std::vector<std::size_t>{1, 2, 3, 5}));
  EXPECT_TRUE(database->remarks.empty());
}

/// Presses of 20 frames with 20 unloaded frames before each; the reading follows the load of `late` frames before.
struct LabelledPresses {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;
};

LabelledPresses labelled_presses(std::size_t late) {
  constexpr std::size_t kPresses = 20;
  constexpr std::size_t kFrames = 20;
  Random random(7);
  const auto newtons = [](std::size_t frame) {
    const std::size_t press = frame / (2 * kFrames);
    return frame / kFrames % 2 == 0 ? 0.0 : 1.0 + static_cast<double>(press * 7 % kPresses);
  };
  LabelledPresses presses;
  for (std::size_t k = 0; k < 2 * kPresses * kFrames; ++k) {
    RawFrame& frame = presses.frames.emplace_back();
    frame.time = std::chrono::milliseconds(10 * k);
    for (int taxel = 0; taxel < 6; ++taxel) {
      const double pressed = 20.0 + 30.0 * newtons(k - std::min(late, k));
      frame.counts.push_back(static_cast<float>(std::round(pressed + random.normal())));
    }
    presses.loads.push_back({k, LoadKind::force, kAll, newtons(k)});
  }
  return presses;
}

TEST(SampleDatabase, has_nothing_to_remark_on_good_labels) {
  const auto [frames, loads] = labelled_presses(0);
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database) << database.error().message;
  EXPECT_TRUE(database->remarks.empty()) << database->remarks[0];
}

TEST(SampleDatabase, leaves_out_unloaded_frames_that_are_pressed) {
  auto [frames, loads] = labelled_presses(0);
  for (const std::size_t frame : {133U, 134U, 255U}) frames[frame].counts.assign(6, 60.0F);
  frames[255].counts.assign(6, 22.0F);  // noise
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database) << database.error().message;
  EXPECT_EQ(database->remarks,
            (std::vector<std::string>{"2 of 400 unloaded frames are pressed: left out, the first 133"}));
  EXPECT_EQ(database->samples.size(), frames.size() - 2);
}

TEST(SampleDatabase, an_array_that_warms_up_is_not_pressed) {
  auto [frames, loads] = labelled_presses(0);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    frames[k].temperature_celsius = 20.0 + 0.05 * static_cast<double>(k);
    for (float& count : frames[k].counts) count += static_cast<float>(0.1 * static_cast<double>(k));
  }
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database) << database.error().message;
  EXPECT_TRUE(database->remarks.empty()) << database->remarks[0];
}

TEST(SampleDatabase, says_that_labels_are_shifted) {
  const auto [frames, loads] = labelled_presses(3);
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database) << database.error().message;
  ASSERT_FALSE(database->remarks.empty());
  EXPECT_NE(database->remarks.back().find("the loads fit the readings 3 frames later"), std::string::npos)
      << database->remarks.back();
}

TEST(SampleDatabase, says_that_labels_of_presses_of_equal_force_are_shifted) {
  for (const std::size_t late : {0U, 3U}) {
    Recording presses;
    for (std::size_t k = 0; k < 600; ++k) {
      RawFrame& frame = presses.frames.emplace_back();
      frame.time = std::chrono::milliseconds(10 * k);
      frame.counts.assign(6, 20.0F);
      const auto pressed = [](std::size_t time) { return time / 20 % 6; };
      if (k >= 20) {
        frame.counts[pressed(k - late)] = 300.0F;
        frame.counts[(pressed(k - late) + 1) % 6] = 120.0F;
      }
      const std::size_t row = pressed(k) / 3;
      const std::size_t col = pressed(k) % 3;
      presses.loads.push_back(
          {k, LoadKind::force, k < 20 ? kAll : TaxelRegion{row, col, row, col}, k < 20 ? 0.0 : 5.0});
    }
    const auto database = build_sample_database(bare_array(), presses.frames, presses.loads);
    ASSERT_TRUE(database) << database.error().message;
    if (late == 0) {
      EXPECT_TRUE(database->remarks.empty()) << database->remarks[0];
    } else {
      EXPECT_EQ(database->remarks,
                (std::vector<std::string>{"the loads fit the readings 3 frames later (577 of 577 then press where the "
                                          "array feels it, as labelled 493 of 580): check them"}));
    }
  }
}

TEST(SampleDatabase, where_memory_ends_keeps_some_of_many_frames_of_a_place_and_all_of_a_rare_one) {
  ArrayDescription array = bare_array();
  array.rows = array.cols = 32;
  constexpr std::size_t kMany = 14'000;  // of 13 kB
  Recording presses;
  const auto add = [&](const TaxelRegion& where, double newtons) {
    presses.loads.push_back({presses.frames.size(), LoadKind::force, where, newtons});
    RawFrame& frame = presses.frames.emplace_back();
    frame.time = std::chrono::milliseconds(presses.frames.size());
    frame.counts.assign(array.taxel_count(), static_cast<float>(20.0 + newtons));
  };
  for (std::size_t k = 0; k < 10; ++k) add(all_taxels(array), 0.0);
  for (std::size_t k = 0; k < 100; ++k) add({1, 1, 1, 1}, 5.0);
  const auto few = build_sample_database(array, presses.frames, presses.loads);
  ASSERT_TRUE(few) << few.error().message;
  EXPECT_EQ(few->samples.size(), 110U);
  for (std::size_t k = 0; k < kMany; ++k) add({0, 0, 0, 0}, 1.0 + static_cast<double>(k * 9 % kMany) / 200.0);
  const auto many = build_sample_database(array, presses.frames, presses.loads);
  ASSERT_TRUE(many) << many.error().message;
  ASSERT_EQ(many->samples.size(), 10U + 100U + 4000U);
  EXPECT_EQ(std::count(many->remarks.begin(), many->remarks.end(),
                       "14110 labelled frames repeat: 4110 of them are used, evenly over places and forces"),
            1);
  float lightest = 1000.0F;
  float heaviest = 0.0F;
  for (const Sample& sample : many->samples) {
    if (sample.known_newtons[0] <= 0.0F) continue;
    lightest = std::min(lightest, sample.known_newtons[0]);
    heaviest = std::max(heaviest, sample.known_newtons[0]);
  }
  EXPECT_EQ(lightest, 1.0F);
  EXPECT_EQ(heaviest, 70.995F);
}

TEST(SampleDatabase, asks_whether_grams_are_newtons) {
  auto [frames, loads] = labelled_presses(0);
  for (Load& load : loads) load.value *= 1000.0 / 9.80665;
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database) << database.error().message;
  ASSERT_EQ(database->remarks.size(), 1U);
  EXPECT_EQ(database->remarks[0],
            "the load of frame 700 presses all with 2.04e+03 N, 3.4 MPa over the 6 taxels that feel it: is it in "
            "newtons? It may be in grams (33.3 kPa then) or millinewtons (3.4 kPa then)");
}

/// The area is that of the taxels that feel the load, however many the label names.
TEST(SampleDatabase, asks_whether_kilopascals_are_newtons) {
  auto [frames, loads] = labelled_presses(0);
  for (Load& load : loads) load.value *= 20.0;
  for (RawFrame& frame : frames) std::fill(frame.counts.begin() + 1, frame.counts.end(), 20.0F);
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database) << database.error().message;
  ASSERT_EQ(database->remarks.size(), 1U);
  EXPECT_EQ(
      database->remarks[0],
      "the load of frame 700 presses all with 400 N, 4 MPa over the 1 taxel that feels it: is it in newtons? It may "
      "be in grams (39.2 kPa then) or millinewtons (4 kPa then) or kPa (400 kPa then)");
}

TEST(SampleDatabase, asks_whether_kilopascals_are_pascals) {
  auto [frames, loads] = labelled_presses(0);
  for (Load& load : loads) load = {load.frame, LoadKind::pressure, load.where, 5e5 * load.value};
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database) << database.error().message;
  ASSERT_EQ(database->remarks.size(), 1U);
  EXPECT_EQ(
      database->remarks[0],
      "the load of frame 700 presses all with 6e+03 N, 10 MPa over the 6 taxels that feel it: is it in kPa? It may "
      "be in Pa (10 kPa then)");
}

TEST(SampleDatabase, does_not_doubt_a_pressure_because_the_array_is_large) {
  auto [frames, loads] = labelled_presses(0);
  for (Load& load : loads) load = {load.frame, LoadKind::pressure, load.where, 1.35e4 * load.value};
  ArrayDescription array = bare_array();
  array.taxel_area_m2 = 0.01;
  const auto database = build_sample_database(array, frames, loads);
  ASSERT_TRUE(database) << database.error().message;
  EXPECT_EQ(database->remarks, std::vector<std::string>{}) << "270 kPa, and 16 kN";
}

TEST(SampleDatabase, leaves_out_a_taxel_that_flickers) {
  auto [frames, loads] = labelled_presses(0);
  Random random(11);
  for (RawFrame& frame : frames) frame.counts[4] = random.below(2) == 0 ? 3.0F : 900.0F;
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database) << database.error().message;
  EXPECT_EQ(database->samples.size(), frames.size());
  EXPECT_EQ(database->array.absent, (std::vector<std::size_t>{4}));
  ASSERT_EQ(database->remarks.size(), 1U);
  EXPECT_EQ(database->remarks[0], "r1c1 flickers while nothing presses: left out as if absent; check the contact");
}

TEST(SampleDatabase, never_leaves_out_the_only_taxel) {
  std::vector<RawFrame> frames(40);
  Random random(12);
  for (RawFrame& frame : frames) frame.counts = {random.below(2) == 0 ? 3.0F : 900.0F, 0.0F};
  std::vector<Load> loads;
  for (std::size_t k = 0; k < frames.size(); ++k) loads.push_back({k, LoadKind::force, {0, 0, 0, 0}, 0.0});
  ArrayDescription array = bare_array();
  array.rows = 1;
  array.cols = 2;
  EXPECT_EQ(find_flickering_taxels(array, frames, loads), (std::vector<std::size_t>{0}));
  array.absent = {1};
  EXPECT_TRUE(find_flickering_taxels(array, frames, loads).empty());
  array.absent.clear();
  array.cols = 1;
  for (RawFrame& frame : frames) frame.counts.resize(1);
  EXPECT_TRUE(find_flickering_taxels(array, frames, loads).empty());
}

/// A touch comes and goes while frames are called unloaded, on some taxels or on one.
TEST(SampleDatabase, taxels_that_are_touched_do_not_flicker) {
  for (const std::size_t touched : {1U, 3U}) {
    auto [frames, loads] = labelled_presses(0);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const bool is_touched = k % 20 > 14;
      for (std::size_t taxel = 0; taxel < touched && is_touched; ++taxel) frames[k].counts[taxel] += 150.0F;
    }
    const auto database = build_sample_database(bare_array(), frames, loads);
    ASSERT_TRUE(database) << database.error().message;
    EXPECT_TRUE(database->array.absent.empty());
  }
}

TEST(SampleDatabase, finds_where_the_readout_saturates_before_its_adc) {
  auto [frames, loads] = labelled_presses(0);
  for (RawFrame& frame : frames) {
    for (float& count : frame.counts) count = std::min(count, 300.0F);
  }
  const auto database = build_sample_database(bare_array(), frames, loads);
  ASSERT_TRUE(database) << database.error().message;
  EXPECT_EQ(database->array.readout.rail_counts, 300.0);
  EXPECT_EQ(database->remarks,
            (std::vector<std::string>{
                "readings end at 300 counts under whatever load: taken for saturated there (rail_counts)"}));
}

}  // namespace
}  // namespace dermis::learn::calibration
