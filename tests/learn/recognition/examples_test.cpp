// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/examples.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "simulated_touches.hpp"

namespace dermis::learn::recognition {
namespace {

std::string error_of(const LabelledFrames& data) {
  const Status status = data.validate();
  if (status) return "no error";
  EXPECT_EQ(status.error().kind, ErrorKind::bad_input);
  return status.error().message;
}

TEST(LabelledFrames, gives_the_frames_of_a_label) {
  LabelledFrames data = support::gestures(1, 1);
  const Label& label = data.labels[1];
  const Segment segment = data.segment(label);
  ASSERT_EQ(segment.frames.size(), (label.last - label.first + 1) * data.layout.readings);
  EXPECT_EQ(segment.frames.data(), data.frames.data() + label.first * data.layout.readings);
  EXPECT_TRUE(segment.extras.empty());
  EXPECT_EQ(error_of(data), "no error");
}

TEST(LabelledFrames, names_two_labels_that_overlap) {
  LabelledFrames data = support::gestures(2, 1);
  data.labels[3].first = data.labels[2].last;
  EXPECT_EQ(error_of(data), "label 'g3' overlaps label 'g2' at frame " + std::to_string(data.labels[2].last) +
                                "; a frame belongs to one example");
}

TEST(LabelledFrames, names_a_label_without_frames) {
  LabelledFrames data = support::poses(2, 1);
  data.labels[7].last = 8;
  EXPECT_EQ(error_of(data), "label 'p7' ends at frame 8; there are 8 frames, counted from 0");
  data.labels[7].last = 6;
  EXPECT_EQ(error_of(data), "label 'p7' ends before it begins");
}

TEST(LabelledFrames, names_an_id_that_stands_twice) {
  LabelledFrames data = support::poses(2, 1);
  data.labels[7].id = "p0";
  EXPECT_EQ(error_of(data), "label 'p0' stands twice; give each its own id");
}

TEST(LabelledFrames, names_a_reading_that_is_no_number) {
  LabelledFrames data = support::poses(2, 1);
  data.frames[3 * data.layout.readings + 5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(error_of(data), "reading 5 of frame 3 is not a number; write 0 where nothing was measured");
}

TEST(HeldImage, is_the_mean_of_the_frames_with_half_the_largest_force) {
  LabelledFrames data;
  data.layout = support::one_array(1, 2);
  data.frames = {0, 1, 8, 0, 6, 2, -3, 0};
  data.labels = {{"a", 0, 3, "x"}};
  EXPECT_EQ(held_image(data, data.labels[0]), (std::vector<float>{7, 1}));
}

}  // namespace
}  // namespace dermis::learn::recognition
