// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bytes/recordings/hdf5_plugin.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/full_disk.hpp"
#include "support/mutations.hpp"
#include "support/random_frames.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

const std::optional<FrameShape> kAnyShape;

Status write_file(const std::string& path, FrameShape shape, const std::vector<RawFrame>& frames,
                  const FrameNotes& notes = {}) {
  const auto writer = by_hdf5(&Hdf5Plugin::create_frames, path, shape, notes);
  if (!writer) return writer.error();
  return support::write_all(**writer, frames);
}

Result<std::vector<RawFrame>> read_file(const std::string& path) {
  const auto reader = by_hdf5(&Hdf5Plugin::open_frames, path, kAnyShape);
  if (!reader) return reader.error();
  return support::read_all(**reader);
}

void expect_round_trip(FrameShape shape, const std::vector<RawFrame>& frames) {
  const support::TemporaryFolder folder;
  const Status written = write_file(folder.file("f.h5"), shape, frames);
  ASSERT_TRUE(written) << written.error().message;
  const auto reader = by_hdf5(&Hdf5Plugin::open_frames, folder.file("f.h5"), kAnyShape);
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ((*reader)->shape(), shape);
  support::expect_same_frames(**reader, frames);
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(Hdf5Frames, give_back_every_bit) {
  expect_round_trip({3, 4}, support::random_frames(1, 3000, 12, support::RandomCounts::whole));
  expect_round_trip({3, 4}, support::random_frames(2, 3000, 12, support::RandomCounts::any_bits));
  expect_round_trip({64, 160}, support::random_frames(3, 60, 10240, support::RandomCounts::whole));
  expect_round_trip({1, 1}, {});
}

TEST(Hdf5Frames, rewrite_whole_counts_where_a_later_frame_has_others) {
  for (const float count : {0.5F, -1.0F, -0.0F, 65536.0F, std::nanf(""), std::numeric_limits<float>::infinity()}) {
    std::vector<RawFrame> frames = support::random_frames(4, 2500, 12);
    frames[2100].counts[7] = count;
    expect_round_trip({3, 4}, frames);
  }
}

TEST(Hdf5Frames, hold_the_temperatures_of_several_sensors) {
  for (const std::size_t sensors : {1U, 12U}) {
    std::vector<RawFrame> frames = support::random_frames(6, 1500, 12);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      frames[k].sensor_celsius.assign(sensors, 20.0F + 0.01F * static_cast<float>(k));
    }
    frames[1300].sensor_celsius.back() = std::nanf("");
    expect_round_trip({3, 4}, frames);
  }
}

TEST(Hdf5Frames, sensors_that_a_frame_lacks_have_no_reading) {
  const support::TemporaryFolder folder;
  std::vector<RawFrame> frames = support::random_frames(7, 3, 12);
  frames[0].sensor_celsius = {20.0F, 21.0F};
  frames[2].sensor_celsius = {20.0F, 21.0F, 22.0F};
  ASSERT_TRUE(write_file(folder.file("f.h5"), {3, 4}, frames));
  const Result<std::vector<RawFrame>> read = read_file(folder.file("f.h5"));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->at(0).sensor_celsius.size(), 3U);
  EXPECT_EQ(read->at(0).sensor_celsius[1], 21.0F);
  EXPECT_TRUE(std::isnan(read->at(0).sensor_celsius[2]));
  ASSERT_EQ(read->at(1).sensor_celsius.size(), 3U);
  EXPECT_TRUE(std::isnan(read->at(1).sensor_celsius[0]));
  EXPECT_EQ(read->at(2).sensor_celsius, frames[2].sensor_celsius);
}

TEST(Hdf5Frames, sensors_that_come_later_are_kept_and_have_no_reading_before) {
  const support::TemporaryFolder folder;
  std::vector<RawFrame> frames = support::random_frames(8, 3000, 12, support::RandomCounts::whole);
  for (std::size_t k = 1100; k < 2500; ++k) frames[k].sensor_celsius = {0.01F * static_cast<float>(k)};
  for (std::size_t k = 2500; k < 3000; ++k) frames[k].sensor_celsius = {0.01F * static_cast<float>(k), 21.0F};
  ASSERT_TRUE(write_file(folder.file("f.h5"), {3, 4}, frames));
  const Result<std::vector<RawFrame>> read = read_file(folder.file("f.h5"));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), frames.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    std::vector<float> expected = frames[k].sensor_celsius;
    expected.resize(2, std::nanf(""));
    frames[k].sensor_celsius = expected;
    support::expect_same_frame(read->at(k), frames[k]);
  }
}

TEST(Hdf5Frames, keep_what_is_said_of_all_frames) {
  const support::TemporaryFolder folder;
  const FrameNotes notes{"chest", "[array]\nname = \"chest\"\n# \xC2\xB5\n", "00ff", "sim:multitouch"};
  ASSERT_TRUE(write_file(folder.file("f.h5"), {1, 2}, {}, notes));
  const auto reader = by_hdf5(&Hdf5Plugin::open_frames, folder.file("f.h5"), kAnyShape);
  ASSERT_TRUE(reader);
  EXPECT_EQ((*reader)->notes(), notes);
}

TEST(Hdf5Frames, with_a_flipped_bit_are_refused_or_the_same) {
  const support::TemporaryFolder folder;
  const std::vector<RawFrame> frames = support::random_frames(9, 300, 12, support::RandomCounts::whole);
  ASSERT_TRUE(write_file(folder.file("f.h5"), {3, 4}, frames));
  std::string bytes = support::read_bytes(folder.file("f.h5"));
  Random random(10);
  for (int k = 0; k < 500; ++k) {
    const std::uint64_t bit = random.below(8 * bytes.size());
    const auto flip = [&] { bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8); };
    flip();
    support::write_bytes(folder.file("flipped.h5"), bytes);
    flip();
    const Result<std::vector<RawFrame>> read = read_file(folder.file("flipped.h5"));
    if (!read) continue;
    ASSERT_EQ(read->size(), frames.size()) << "bit " << bit;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      ASSERT_EQ(read->at(i).counts, frames[i].counts) << "bit " << bit << ", frame " << i;
      ASSERT_EQ(read->at(i).time, frames[i].time) << "bit " << bit << ", frame " << i;
    }
  }
}

TEST(Hdf5Frames, count_the_lost_frames) {
  const support::TemporaryFolder folder;
  std::vector<RawFrame> frames = support::random_frames(5, 3, 2);
  for (RawFrame& frame : frames) frame.acquisition.lost_before = 2;
  ASSERT_TRUE(write_file(folder.file("f.h5"), {1, 2}, frames));
  const auto reader = by_hdf5(&Hdf5Plugin::open_frames, folder.file("f.h5"), kAnyShape);
  ASSERT_TRUE(reader);
  ASSERT_TRUE(support::read_all(**reader));
  EXPECT_EQ((*reader)->statistics().frames, 3U);
  EXPECT_EQ((*reader)->statistics().lost_frames, 6U);
}

TEST(Hdf5Frames, of_another_shape_are_refused) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("f.h5");
  ASSERT_TRUE(write_file(path, {3, 4}, {}));
  const auto reader = by_hdf5(&Hdf5Plugin::open_frames, path, FrameShape{12, 32});
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().message, path + ": has 3x4 taxels, the array is 12x32");
}

TEST(Hdf5Frames, leave_nothing_behind_without_commit) {
  const support::TemporaryFolder folder;
  {
    const auto writer = by_hdf5(&Hdf5Plugin::create_frames, folder.file("f.h5"), FrameShape{1, 2}, FrameNotes());
    ASSERT_TRUE(writer);
    for (const RawFrame& frame : support::random_frames(6, 3000, 2)) ASSERT_TRUE((*writer)->write(frame));
  }
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(Hdf5Frames, need_a_regular_file) {
  const auto writer = by_hdf5(&Hdf5Plugin::create_frames, "/dev/full", FrameShape{1, 2}, FrameNotes());
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().message, "cannot write '/dev/full': this format needs a regular file");
  const auto reader = by_hdf5(&Hdf5Plugin::open_frames, "/dev/null", kAnyShape);
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().message, "/dev/null: HDF5 needs a regular file");
}

TEST(Hdf5Frames, end_with_one_error_wherever_the_disk_is_full) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("f.h5");
  std::vector<RawFrame> frames = support::random_frames(7, 600, 1024);  // several chunks
  frames[550].counts[0] = 0.5F;                                         // and a rewriting
  const auto write = [&] { return write_file(path, {32, 32}, frames); };
  ASSERT_EQ(support::write_within(RLIM_INFINITY, path, write), 0);
  const rlim_t whole = std::filesystem::file_size(path);
  std::filesystem::remove(path);
  Random random(8);
  for (int i = 0; i < 16; ++i) {
    const rlim_t size = i < 6 ? static_cast<rlim_t>(i) * 800 : random.below(whole);
    EXPECT_EQ(support::write_within(size, path, write), 1) << size;
    EXPECT_EQ(folder.file_count(), 0U) << size;
  }
}

TEST(Hdf5Frames, name_what_is_no_hdf5_file) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("f.h5");
  const auto missing = by_hdf5(&Hdf5Plugin::open_frames, path, kAnyShape);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().message, "cannot open '" + path + "': No such file or directory");
  support::write_bytes(path, "time_s,r0c0\n");
  const auto text = by_hdf5(&Hdf5Plugin::open_frames, path, kAnyShape);
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().kind, ErrorKind::bad_input);
  EXPECT_TRUE(text.error().message.starts_with(path + ": is no HDF5 file")) << text.error().message;
}

TEST(Hdf5Frames, that_are_cut_give_an_error) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("f.h5");
  ASSERT_TRUE(write_file(path, {3, 4}, support::random_frames(9, 200, 12)));
  const std::string bytes = support::read_bytes(path);
  for (std::size_t size = 0; size < bytes.size(); size += 397) {
    support::write_bytes(path, bytes.substr(0, size));
    const auto read = read_file(path);
    ASSERT_FALSE(read) << size;
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace dermis::bytes::recordings
