// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognising/labelled_examples.hpp"

#include <gtest/gtest.h>

#include "support/force_mat.hpp"

namespace dermis::recognising {
namespace {

using support::error_of;
using support::kPressed;
using support::kShape;
using support::later;
using support::MatFiles;
using support::pressed;

/// Labels of two presses of each class, four frames long.
std::string labels(const MatFiles& mat, const std::string& recording = {}) {
  std::string text = recording.empty() ? "id,first,last,class\n" : "id,first,last,class,recording\n";
  const std::string end = recording.empty() ? "\n" : "," + recording + "\n";
  text += "a,0,3,soft" + end + "b,4,7,hard" + end;
  support::write_bytes(mat.file("labels.csv"), text);
  return mat.file("labels.csv");
}

std::vector<RawFrame> two_presses() {
  return pressed({1.0F, 2.0F, 2.0F, 1.0F, 4.0F, 8.0F, 8.0F, 4.0F});
}

TEST(ReadExamples, of_a_recording_are_its_readings_at_the_rate_of_its_times) {
  const MatFiles mat;
  ExampleOptions options;
  options.in = {mat.write("rec.mcap", two_presses())};
  options.data.labels = labels(mat);
  const auto data = read_examples(options);
  ASSERT_TRUE(data) << error_of(data);
  EXPECT_EQ(data->layout.readings, kShape.taxel_count());
  EXPECT_NEAR(data->layout.rate_hz, 100.0, 1e-9);
  EXPECT_FALSE(data->layout.has_forces());
  ASSERT_EQ(data->frame_count(), 8U);
  EXPECT_EQ(data->frames[5 * kShape.taxel_count() + kPressed], 8.0F);
  ASSERT_EQ(data->labels.size(), 2U);
  EXPECT_EQ(data->labels[1].name, "hard");
}

TEST(ReadExamples, of_recordings_with_a_model_are_forces) {
  const MatFiles mat;
  ExampleOptions options;
  options.in = {mat.write("first.mcap", two_presses()), mat.write("second.csv", two_presses())};
  options.model = mat.model();
  options.data.labels = labels(mat, "second.csv");
  options.data.rate_hz = 50.0;
  const auto data = read_examples(options);
  ASSERT_TRUE(data) << error_of(data);
  EXPECT_TRUE(data->layout.has_forces());
  EXPECT_EQ(data->layout.rate_hz, 50.0);
  EXPECT_EQ(data->layout.arrays.front().row_pitch_mm, 4.0);
  ASSERT_EQ(data->frame_count(), 16U);
  EXPECT_EQ(data->labels.front().first, 8U);
}

TEST(ReadExamples, of_several_arrays_stand_side_by_side_as_in_the_first_recording) {
  const MatFiles mat;
  std::vector<std::string> notices;
  ExampleOptions options;
  options.in = {mat.write_two("first.mcap", two_presses(), two_presses()),
                mat.write_two("second.mcap", two_presses(), two_presses())};
  options.data.labels = labels(mat, "second.mcap");
  options.model = mat.suit();
  const auto data = read_examples(options, {.notice = [&](const std::string& line) { notices.push_back(line); }});
  ASSERT_TRUE(data) << error_of(data);
  EXPECT_EQ(learn::recognition::names_of(data->layout.arrays), (std::vector<std::string>{"right", "left"}));
  EXPECT_TRUE(data->layout.has_forces());
  EXPECT_EQ(data->frame_count(), 16U);
  EXPECT_NEAR(data->frames[kShape.taxel_count() + kPressed], 1.0F, 1e-4F);
  EXPECT_TRUE(notices.empty());
  options.in.back() = mat.write("second.mcap", two_presses());
  options.model.clear();
  EXPECT_EQ(error_of(read_examples(options)),
            "second.mcap: has frames of 3x4 taxels, first.mcap of left 3x4, right 3x4 taxels; learn from recordings of "
            "the same arrays");
}

TEST(ReadExamples, have_further_readings_and_their_mean_where_one_is_missing) {
  const MatFiles mat;
  std::vector<std::string> notices;
  const auto read = [&](const ExampleOptions& options) {
    return read_examples(options, {.notice = [&](const std::string& line) { notices.push_back(line); }});
  };
  ExampleOptions options;
  options.in = {mat.write("a.csv", two_presses()), mat.write("b.csv", later(two_presses(), std::chrono::seconds(5)))};
  options.data.labels = labels(mat, "b.csv");
  options.data.extras = mat.file("joints.csv");
  support::write_bytes(options.data.extras, "time_s,elbow\n1,10\n1.04,20\n6.04,30\n");
  const auto data = read(options);
  ASSERT_TRUE(data) << error_of(data);
  EXPECT_EQ(data->layout.extras, 1U);
  EXPECT_EQ(data->extras, (std::vector<float>{10, 10, 10, 10, 20, 20, 20, 20, 20, 20, 20, 20, 30, 30, 30, 30}));
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices[0].find("joints.csv: 4 of 8 frames of b.csv"), std::string::npos) << notices[0];
  support::write_bytes(options.data.extras, "time_s,elbow\n3,10\n");
  EXPECT_EQ(error_of(read(options)).find(options.data.extras + ": 'elbow' has no value at the times of the frames"),
            0U);
}

TEST(ReadExamples, refuses_recordings_that_are_not_alike) {
  const MatFiles mat;
  ExampleOptions options;
  options.data.labels = labels(mat);
  const std::string first = mat.write("rec.csv", two_presses());
  options.in = {first, first};
  EXPECT_EQ(error_of(read_examples(options)),
            "in: two recordings are called rec.csv; rename one, so that the labels can tell them apart");
  options.in = {first, mat.write("other.csv", pressed({1.0F, 2.0F}, {2, 3}), {2, 3})};
  EXPECT_EQ(error_of(read_examples(options)),
            "other.csv: has frames of 2x3 taxels, rec.csv of 3x4 taxels; learn from recordings of the same arrays");
  std::vector<RawFrame> slow = two_presses();
  for (RawFrame& frame : slow) frame.time *= 2;
  options.in = {first, mat.write("slow.csv", slow)};
  EXPECT_EQ(error_of(read_examples(options)),
            "slow.csv: has 50 frames a second, rec.csv 100; learn from recordings of one rate");
}

TEST(ReadExamples, refuses_what_has_no_end_or_ends_before_it_is_tared) {
  const MatFiles mat;
  ExampleOptions options;
  options.data.labels = labels(mat);
  options.in = {"sim:idle?frames=1"};
  EXPECT_EQ(error_of(read_examples(options)), "'sim:idle?frames=1': is a device, which has no end; record it first");
  options.in = {mat.write("rec.csv", two_presses())};
  options.tare = true;
  EXPECT_EQ(error_of(read_examples(options)), options.in.front() + ": ends before it is tared, which takes 1 s");
}

TEST(ReadExamples, wants_recordings_or_plain_files_and_not_both) {
  ExampleOptions options;
  EXPECT_NE(error_of(read_examples(options)).find("name the examples"), std::string::npos);
  options.tare = true;
  EXPECT_NE(error_of(read_examples(options)).find("are for recordings"), std::string::npos);
  options.in = {"rec.csv"};
  options.data.frames = "frames.npy";
  EXPECT_NE(error_of(read_examples(options)).find("in: excludes"), std::string::npos);
  options.data.rate_hz = -1.0;
  EXPECT_EQ(error_of(read_examples(options)), "rate: must be 0.001 to 1e6");
}

}  // namespace
}  // namespace dermis::recognising
