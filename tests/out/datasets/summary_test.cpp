// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/datasets/summary.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace dermis::out::datasets {
namespace {

/// Ten episodes of an array of 1x3, of which the last two are held out.
EpisodeTally small_tally() {
  ArrayTally array;
  array.name = "chest";
  array.rows = 1;
  array.cols = 3;
  array.has_forces = true;
  array.frames = 100;
  array.episodes = 10;
  array.time = std::chrono::milliseconds(900);
  array.steps = 10;
  array.age = std::chrono::milliseconds(50);
  array.oldest = std::chrono::milliseconds(12);
  array.empty_frames = 10;
  array.invalid = {0, 90, 1};
  array.highest = 12.5F;
  array.first_picture = {1.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F};
  array.last_picture = array.first_picture;
  EpisodeTally tally;
  tally.episodes = 10;
  tally.steps = 10;
  tally.arrays = {array};
  tally.held_out = 2;
  tally.how = {{"zero", "that of the calibration"}};
  for (int k = 0; k < 10; ++k) tally.sources.push_back({"run<1>.mcap", 1, Nanos(k), Nanos(k)});
  return tally;
}

TEST(Summary, tells_in_few_lines_what_a_person_must_know) {
  const std::vector<std::string> expected = {
      "held out: episodes 8 to 9",
      "chest: 1x3, 0 to 12.5 N, 100 frames a second, the newest 5 ms old (at most 12 ms); faulty: r0c1 always, r0c2 at "
      "times"};
  EXPECT_EQ(summary_lines(small_tally()), expected);
}

TEST(Summary, has_masks_and_the_split_for_programs) {
  const auto json = nlohmann::json::parse(summary_json(small_tally()));
  EXPECT_EQ(json["splits"]["train"], "0:8");
  EXPECT_EQ(json["splits"]["val"], "8:10");
  EXPECT_EQ(json["arrays"]["chest"]["always_faulty"].dump(), "[[false,true,false]]");
  EXPECT_EQ(json["arrays"]["chest"]["ever_faulty"].dump(), "[[false,true,true]]");
  EXPECT_EQ(json["episodes"].size(), 10U);
}

TEST(Summary, is_a_page_with_the_first_and_the_last_picture) {
  const std::string page = summary_page(small_tally(), "touch");
  EXPECT_NE(page.find("that of the calibration"), std::string::npos);
  EXPECT_NE(page.find("r0c1 always"), std::string::npos);
  EXPECT_NE(page.find("run&lt;1&gt;.mcap"), std::string::npos);
  EXPECT_NE(page.find("first [N]"), std::string::npos);
  EXPECT_NE(page.find("last [N]"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

TEST(Summary, names_no_more_faulty_taxels_than_a_line_holds) {
  EpisodeTally tally = small_tally();
  tally.arrays[0].cols = 20;
  tally.arrays[0].invalid.assign(20, 90);
  EXPECT_NE(summary_lines(tally)[1].find("r0c7 and 12 more always"), std::string::npos) << summary_lines(tally)[1];
}

}  // namespace
}  // namespace dermis::out::datasets
