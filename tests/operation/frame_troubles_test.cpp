// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/operation/frame_troubles.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "force_mat.hpp"

namespace dermis::operation {
namespace {

/// What is said of the frames of a file.
std::vector<std::string> troubles_of(const MatFiles& mat, const std::string& from) {
  const auto operation = open_operation(mat.model(), from);
  EXPECT_TRUE(operation) << error_of(operation);
  FrameTroubles troubles(**operation, from);
  RawFrame raw;
  ForceFrame force;
  for (std::size_t number = 1; (*operation)->frames->next(raw).value(); ++number) {
    (*operation)->pipeline.process(raw, force);
    troubles.add(force, number);
  }
  EXPECT_GT(troubles.frames(), 0U);
  return troubles.describe();
}

TEST(FrameTroubles, has_nothing_to_say_of_good_frames) {
  const MatFiles mat;
  EXPECT_TRUE(troubles_of(mat, mat.write("frames.csv", pressed({1.0F, 2.0F}))).empty());
}

TEST(FrameTroubles, says_how_many_frames_were_rejected_and_where_the_first_stands) {
  const MatFiles mat;
  std::vector<RawFrame> frames = pressed({1.0F, 1.0F, 1.0F, 1.0F});
  frames[2].time = frames[0].time;
  const auto of_text = troubles_of(mat, mat.write("frames.csv", frames));
  ASSERT_EQ(of_text.size(), 1U);
  EXPECT_EQ(of_text.front().rfind("1 of 4 frames rejected, the first: " + mat.file("frames.csv") + ":4: ", 0), 0U)
      << of_text.front();
  const auto of_recording = troubles_of(mat, mat.write("rec.mcap", frames));
  ASSERT_EQ(of_recording.size(), 1U);
  EXPECT_NE(of_recording.front().find("rec.mcap: frame 3: "), std::string::npos) << of_recording.front();
}

TEST(FrameTroubles, says_which_taxels_had_no_reading) {
  const MatFiles mat;
  const auto lines = troubles_of(mat, mat.write("frames.csv", pressed({1.0F, NAN})));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines.front().find("r1c1 in 1 of 2 frames"), std::string::npos) << lines.front();
}

}  // namespace
}  // namespace dermis::operation
