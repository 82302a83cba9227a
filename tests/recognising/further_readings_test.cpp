// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognising/further_readings.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "support/force_mat.hpp"

namespace dermis::recognising {
namespace {

using support::error_of;

/// A table of joint angles.
class Joints {
 public:
  [[nodiscard]] Result<FurtherReadings> read(const std::string& text, const std::string& recording = "rec.mcap") const {
    support::write_bytes(path(), text);
    return FurtherReadings::read(path(), recording);
  }
  [[nodiscard]] FurtherReadings of(const std::string& text, const std::string& recording = "rec.mcap") const {
    Result<FurtherReadings> readings = read(text, recording);
    EXPECT_TRUE(readings) << error_of(readings);
    return *std::move(readings);
  }
  [[nodiscard]] std::string path() const { return folder_.file("joints.csv"); }

 private:
  support::TemporaryFolder folder_;
};

std::vector<float> values_at(FurtherReadings& readings, int milliseconds) {
  readings.move_to(std::chrono::milliseconds(milliseconds));
  return readings.values();
}

TEST(FurtherReadings, are_the_last_ones_not_later_than_a_frame) {
  const Joints joints;
  FurtherReadings readings = joints.of("time_s,elbow,wrist\n1,10,20\n1.1,11,21\n1.1,12,22\n1.2,13,23\n");
  EXPECT_EQ(readings.names(), (std::vector<std::string>{"elbow", "wrist"}));
  EXPECT_EQ(values_at(readings, 1000), (std::vector<float>{10.0F, 20.0F}));
  EXPECT_EQ(values_at(readings, 1099), (std::vector<float>{10.0F, 20.0F}));
  EXPECT_EQ(values_at(readings, 1100), (std::vector<float>{12.0F, 22.0F}));
  EXPECT_EQ(values_at(readings, 1700), (std::vector<float>{13.0F, 23.0F}));
  EXPECT_FALSE(readings.describe_missing());
}

TEST(FurtherReadings, are_missing_before_the_first_and_half_a_second_after_the_last) {
  const Joints joints;
  FurtherReadings readings = joints.of("time_s,elbow,wrist\n1,10,20\n1.3,,21\n1.4,nan,inf\n");
  EXPECT_TRUE(std::isnan(values_at(readings, 999)[0]));
  EXPECT_EQ(values_at(readings, 1500), (std::vector<float>{10.0F, 21.0F}));
  const std::vector<float> late = values_at(readings, 1501);
  EXPECT_TRUE(std::isnan(late[0]));
  EXPECT_EQ(late[1], 21.0F);
  EXPECT_EQ(readings.describe_missing(),
            joints.path() +
                ": 2 of 3 frames of rec.mcap lack a reading of the half second before them; what is "
                "missing counts as the mean");
}

TEST(FurtherReadings, of_one_recording_are_those_of_its_lines) {
  const Joints joints;
  const std::string text = "recording,time_s,elbow\na.mcap,5,1\nb.mcap,2,3\na.mcap,6,2\nb.mcap,4,4\n";
  FurtherReadings of_a = joints.of(text, "a.mcap");
  FurtherReadings of_b = joints.of(text, "b.mcap");
  EXPECT_EQ(of_a.names(), (std::vector<std::string>{"elbow"}));
  EXPECT_EQ(values_at(of_a, 6000), (std::vector<float>{2.0F}));
  EXPECT_EQ(values_at(of_b, 2000), (std::vector<float>{3.0F}));
  EXPECT_EQ(error_of(joints.read(text, "c.mcap")), joints.path() + ": has no line for 'c.mcap'");
}

TEST(FurtherReadings, take_times_since_1970_to_the_nanosecond) {
  const Joints joints;
  FurtherReadings readings = joints.of("time_s,elbow\n1732399503.123456789,1\n");
  const Nanos time(1'732'399'503'123'456'789);
  readings.move_to(time - Nanos(1));
  EXPECT_TRUE(std::isnan(readings.values()[0]));
  readings.move_to(time);
  EXPECT_EQ(readings.values()[0], 1.0F);
}

TEST(FurtherReadings, name_what_is_wrong_with_their_file) {
  const Joints joints;
  const std::string path = joints.path();
  EXPECT_EQ(error_of(joints.read("time_s\n1\n")), path + ": has no reading beside time_s; a column each is expected");
  EXPECT_EQ(error_of(joints.read("time,elbow\n1,2\n")), path + ": has no column 'time_s'; its header is 'time,elbow'");
  EXPECT_EQ(error_of(joints.read("time_s,elbow\nnan,2\n")), path + ":2: time_s 'nan' is not a time in seconds");
  EXPECT_EQ(error_of(joints.read("time_s,elbow\n1,bent\n")), path + ":2: elbow 'bent' is not a number");
  EXPECT_EQ(error_of(joints.read("time_s,elbow\n2,1\n1,1\n")),
            path + ":3: time_s goes back; sort the lines by their time");
  EXPECT_EQ(error_of(joints.read("time_s,elbow\n")), path + ": has no line for 'rec.mcap'");
}

}  // namespace
}  // namespace dermis::recognising
