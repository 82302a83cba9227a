// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/frame_file_info.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <limits>

#include "support/random_frames.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr Nanos kIn2026 = std::chrono::sys_days(std::chrono::year(2026) / 11 / 22).time_since_epoch();
const FrameNotes kNotes{"hand", "[array]\nname = \"hand\"\n", "0123456789abcdef"};

/// Three frames of 3x4 taxels within 20 ms; the second one has no temperature that is a number.
std::vector<RawFrame> three_frames(Nanos start_utc) {
  std::vector<RawFrame> frames(3);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    frames[k].time = std::chrono::milliseconds(10 * k);
    frames[k].acquisition.arrival_utc = start_utc + frames[k].time;
    frames[k].temperature_celsius = 21.5 - static_cast<double>(k);
    frames[k].counts.assign(12, 100.0F);
  }
  frames[1].temperature_celsius = std::numeric_limits<double>::quiet_NaN();
  return frames;
}

/// Of a file of this name with these frames.
FrameFileInfo info_of(const std::string& name, const std::vector<RawFrame>& frames) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file(name);
  const auto sink = create_frames(path, {3, 4}, kNotes);
  EXPECT_TRUE(sink);
  EXPECT_TRUE(support::write_all(**sink, frames));
  const Result<FrameFileInfo> info = frame_file_info(path);
  EXPECT_TRUE(info) << info.error().message;
  EXPECT_EQ(info->bytes, std::filesystem::file_size(path));
  return *info;
}

TEST(FrameFileInfo, every_format_says_how_many_frames_of_which_shape_it_holds) {
  for (const char* const name : {"f.csv", "f.mcap", "f.h5", "f.wiresens.h5", "f.npy"}) {
    SCOPED_TRACE(name);
    const FrameFileInfo info = info_of(name, three_frames(kIn2026));
    EXPECT_EQ(info.format, *frame_format(name));
    EXPECT_EQ(info.frames, 3U);
    EXPECT_EQ(info.shape, (FrameShape{3, 4}));
    EXPECT_TRUE(info.complete);
    EXPECT_TRUE(info.arrays.empty());
  }
}

TEST(FrameFileInfo, a_format_with_times_has_a_duration_and_a_rate) {
  const FrameFileInfo info = info_of("f.csv", three_frames(kIn2026));
  EXPECT_DOUBLE_EQ(info.duration_s.value_or(0.0), 0.02);
  EXPECT_DOUBLE_EQ(info.rate_hz().value_or(0.0), 100.0);
  const FrameFileInfo untimed = info_of("f.npy", three_frames(kIn2026));
  EXPECT_FALSE(untimed.duration_s);
  EXPECT_FALSE(untimed.rate_hz());
}

TEST(FrameFileInfo, one_frame_has_no_rate) {
  EXPECT_FALSE(info_of("f.csv", {three_frames(kIn2026).front()}).rate_hz());
}

TEST(FrameFileInfo, times_before_2000_are_no_clock_times) {
  EXPECT_EQ(info_of("f.h5", three_frames(kIn2026)).start_utc, kIn2026);
  EXPECT_FALSE(info_of("f.h5", three_frames(std::chrono::seconds(5))).start_utc);
}

TEST(FrameFileInfo, the_range_of_temperatures_is_that_of_the_numbers) {
  const auto range = info_of("f.csv", three_frames(kIn2026)).temperature_celsius;
  ASSERT_TRUE(range);
  EXPECT_EQ(*range, std::pair(19.5, 21.5));
  EXPECT_FALSE(info_of("f.npy", three_frames(kIn2026)).temperature_celsius);
}

TEST(FrameFileInfo, the_range_of_temperatures_is_that_of_the_means_of_sensors) {
  std::vector<RawFrame> frames = three_frames(kIn2026);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    frames[k].temperature_celsius.reset();
    frames[k].sensor_celsius = {20.0F + static_cast<float>(k), std::numeric_limits<float>::quiet_NaN(), 25.0F};
  }
  const auto range = info_of("f.csv", frames).temperature_celsius;
  ASSERT_TRUE(range);
  EXPECT_EQ(*range, std::pair(22.5, 23.5));
}

TEST(FrameFileInfo, notes_come_from_formats_that_keep_them) {
  EXPECT_EQ(info_of("f.h5", three_frames(kIn2026)).notes, kNotes);
  const FrameFileInfo recording = info_of("f.mcap", three_frames(kIn2026));
  EXPECT_EQ(recording.notes, kNotes);
  EXPECT_EQ(recording.lost, 0U);
  EXPECT_EQ(recording.compression, "lz4");
  EXPECT_TRUE(recording.software.starts_with("dermis "));
  EXPECT_FALSE(recording.topics.empty());
  EXPECT_EQ(info_of("f.csv", three_frames(kIn2026)).notes, FrameNotes{});
}

TEST(FrameFileInfo, several_arrays_have_shapes_and_rates_of_their_own) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("suit.mcap");
  std::vector<RecordedArray> arrays(2);
  arrays[0].name = "chest";
  arrays[1].name = "back";
  for (RecordedArray& array : arrays) array.shape = {3, 4};
  const auto writer = SuitRecordingWriter::create(path, arrays);
  ASSERT_TRUE(writer) << writer.error().message;
  for (const RawFrame& frame : three_frames(kIn2026)) {
    ASSERT_TRUE((*writer)->write(0, frame));
    ASSERT_TRUE((*writer)->write(1, frame));
  }
  ASSERT_TRUE((*writer)->commit());
  const Result<FrameFileInfo> info = frame_file_info(path);
  ASSERT_TRUE(info) << info.error().message;
  EXPECT_EQ(info->frames, 6U);
  EXPECT_EQ(info->arrays.size(), 2U);
  EXPECT_FALSE(info->shape);
  EXPECT_FALSE(info->rate_hz());

  const Result<FrameFileInfo> one = frame_file_info(path + "#back");
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->frames, 3U);
  EXPECT_EQ(one->notes.name, "back");
  EXPECT_EQ(one->shape, (FrameShape{3, 4}));
  EXPECT_DOUBLE_EQ(one->rate_hz().value_or(0.0), 100.0);
  EXPECT_EQ(one->compression, "lz4");
  EXPECT_NE(frame_file_info(path + "#bock").error().message.find("'back'"), std::string::npos);
}

TEST(FrameFileInfo, a_file_that_is_not_there_is_named) {
  const Result<FrameFileInfo> info = frame_file_info("/no/such/file.csv");
  ASSERT_FALSE(info);
  EXPECT_EQ(info.error().kind, ErrorKind::bad_input);
  EXPECT_NE(info.error().message.find("/no/such/file.csv"), std::string::npos);
}

}  // namespace
}  // namespace dermis::bytes::recordings
