// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/marks.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

using ros_messages::Mark;
using support::TemporaryFolder;

constexpr Nanos kStart{1'760'000'000'000'000'000};

const std::vector<Mark> kRecorded = {{kStart, "", "", "tare"}, {kStart + Nanos(500'000'000), "grasp", "anna"}};

/// A recording of one frame with marks.
std::string recording_with(const TemporaryFolder& folder, const std::vector<Mark>& marks) {
  std::string path = folder.file("walk.mcap");
  const auto writer = SuitRecordingWriter::create(path, {{.name = "chest", .shape = {1, 2}}});
  RawFrame frame;
  frame.time = kStart;
  frame.counts = {1.0F, 2.0F};
  EXPECT_TRUE((*writer)->write(0, frame));
  std::vector<std::uint8_t> message;
  for (const Mark& mark : marks) {
    ros_messages::encode_mark(mark, "suit", message);
    EXPECT_TRUE((*writer)->write(RecordedEvent{kMarksTopic, ros_messages::mark_type(), mark.time, message}));
  }
  EXPECT_TRUE((*writer)->commit());
  return path;
}

void write_beside(const std::string& recording, const std::string& text) {
  std::ofstream(marks_path(recording)) << text;
}

TEST(Marks, are_read_as_they_were_set) {
  const TemporaryFolder folder;
  const auto marks = read_marks(recording_with(folder, kRecorded), kStart);
  ASSERT_TRUE(marks) << marks.error().message;
  EXPECT_EQ(*marks, kRecorded);
}

TEST(Marks, that_were_edited_count_alone_beside_the_events_of_the_server) {
  const TemporaryFolder folder;
  const std::string path = recording_with(folder, kRecorded);
  const std::vector<Mark> edited = {{kStart + Nanos(250'000'001), "lift"}, {kStart + Nanos(750'000'000), ""}};
  ASSERT_TRUE(write_marks(path, kStart, edited));
  const auto marks = read_marks(path, kStart);
  ASSERT_TRUE(marks) << marks.error().message;
  EXPECT_EQ(*marks, (std::vector<Mark>{kRecorded[0], edited[0], edited[1]}));
}

TEST(Marks, of_a_recording_without_any_are_none) {
  const TemporaryFolder folder;
  const auto marks = read_marks(recording_with(folder, {}), kStart);
  ASSERT_TRUE(marks) << marks.error().message;
  EXPECT_TRUE(marks->empty());
}

TEST(Marks, a_file_beside_the_recording_that_is_wrong_is_named) {
  const TemporaryFolder folder;
  const std::string path = recording_with(folder, kRecorded);
  const auto error_of = [&](const std::string& text) {
    write_beside(path, text);
    const auto marks = read_marks(path, kStart);
    return marks ? "" : marks.error().message;
  };
  const std::string file = marks_path(path);
  EXPECT_NE(error_of("seconds,label\n").find("time_s"), std::string::npos);
  EXPECT_EQ(error_of("time_s,label\nsoon,lift\n").find(file + ":2: "), 0U);
  EXPECT_EQ(error_of("time_s,label\n1e12,lift\n"), file + ":2: time_s: is no time of a recording");
}

TEST(Marks, a_label_that_no_table_can_hold_is_refused_and_the_file_stays) {
  const TemporaryFolder folder;
  const std::string path = recording_with(folder, kRecorded);
  ASSERT_TRUE(write_marks(path, kStart, kRecorded));
  for (const std::string& label : {std::string("a,b"), std::string("a\nb"), std::string("\""), std::string(201, 'a')}) {
    EXPECT_FALSE(write_marks(path, kStart, std::vector<Mark>{{kStart, label}})) << label;
  }
  EXPECT_EQ(read_marks(path, kStart).value().back().label, "grasp");
}

}  // namespace
}  // namespace dermis::bytes::recordings
