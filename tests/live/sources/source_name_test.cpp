// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/source_name.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "support/temporary_folder.hpp"

namespace dermis::live::sources {
namespace {

SourceName name_of(const std::string& text) {
  const Result<SourceName> name = SourceName::parse(text);
  EXPECT_TRUE(name) << text;
  return name ? *name : SourceName{};
}

TEST(SourceName, says_what_kind_of_source_it_is) {
  EXPECT_EQ(name_of("frames.csv").kind, SourceKind::file);
  EXPECT_EQ(name_of("file:frames.npy?rate=50").kind, SourceKind::file);
  EXPECT_EQ(name_of("rec.mcap").kind, SourceKind::recording);
  EXPECT_EQ(name_of("rec.mcap#chest").kind, SourceKind::recording);
  EXPECT_EQ(name_of("sim:idle").kind, SourceKind::simulation);
  EXPECT_EQ(name_of("serial:///dev/ttyACM0").kind, SourceKind::device);
  EXPECT_EQ(name_of("file:bytes.bin").kind, SourceKind::device);
  EXPECT_EQ(name_of("nats://hub?robot=r&array=a").kind, SourceKind::stream);
  EXPECT_EQ(name_of("modbus-tcp://hand?map=inspire-rh56&array=palm").kind, SourceKind::bus);
  EXPECT_EQ(name_of("dds://0/rt/chest/raw?type=sensor_msgs/Image").kind, SourceKind::bus);
  EXPECT_EQ(name_of("file:bytes.bin?rate=50&protocol=packed10&rows=4&cols=4").kind, SourceKind::device);
}

TEST(SourceName, tells_the_file_from_the_array_in_it_and_from_what_a_uri_says) {
  EXPECT_EQ(name_of("run/frames.csv").file, "run/frames.csv");
  EXPECT_EQ(name_of("file:/run/frames.npy?rate=50").file, "/run/frames.npy");
  EXPECT_EQ(name_of("run/rec.mcap#chest").file, "run/rec.mcap");
  EXPECT_EQ(name_of("run/rec.mcap#chest").array, "chest");
  EXPECT_EQ(name_of("run/rec.mcap#chest").short_name(), "rec.mcap#chest");
  EXPECT_EQ(name_of("run/rec.mcap").short_name(), "rec.mcap");
  EXPECT_EQ(name_of("file:/run/frames.npy?rate=50").short_name(), "frames.npy");
  EXPECT_EQ(name_of("sim:idle").file, "");
}

TEST(SourceName, a_file_of_the_whole_name_is_meant_before_an_array_in_another) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap#1.csv");
  std::ofstream(path) << "time_s\n";
  EXPECT_EQ(name_of(path).file, path);
  EXPECT_EQ(name_of(path).array, "");
}

TEST(SourceName, a_simulation_without_a_rate_is_read_as_fast_as_it_can_be) {
  EXPECT_TRUE(name_of("sim:idle").needs_rate());
  EXPECT_FALSE(name_of("sim:idle?rate=100").needs_rate());
  EXPECT_FALSE(name_of("udp://127.0.0.1:9000").needs_rate());
}

TEST(SourceName, times_of_a_file_with_a_rate_are_its_own) {
  EXPECT_TRUE(name_of("file:bytes.bin?rate=50").has_times_of_its_own());
  EXPECT_FALSE(name_of("file:bytes.bin").has_times_of_its_own());
  EXPECT_FALSE(name_of("sim:idle?rate=50").has_times_of_its_own());
}

TEST(SourceName, a_topic_is_heard_in_its_domain) {
  const SourceName topic = name_of("dds://7/rt/chest/raw?type=sensor_msgs/Image");
  EXPECT_TRUE(topic.hears(7, "rt/chest/raw"));
  EXPECT_FALSE(topic.hears(0, "rt/chest/raw"));
  EXPECT_FALSE(topic.hears(7, "rt/chest/frame"));
  EXPECT_FALSE(name_of("sim:idle").hears(7, "rt/chest/raw"));
}

TEST(SourceName, refuses_a_uri_that_is_wrong) {
  EXPECT_FALSE(SourceName::parse("sim:idle?speed=3"));
  EXPECT_FALSE(SourceName::parse("http://x"));
}

}  // namespace
}  // namespace dermis::live::sources
