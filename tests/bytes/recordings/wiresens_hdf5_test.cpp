// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>

#include <cmath>

#include "bytes/recordings/hdf5_plugin.hpp"
#include "support/full_disk.hpp"
#include "support/random_frames.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

const std::optional<FrameShape> kAnyShape;

// Files as WiReSens itself writes them are made with h5py in tests/command_line/convert_test.py.

RawFrame frame_at(Nanos time, std::vector<float> counts) {
  RawFrame frame;
  frame.time = time;
  frame.counts = std::move(counts);
  return frame;
}

Status write_file(const std::string& path, FrameShape shape, const std::vector<RawFrame>& frames) {
  const auto writer = by_hdf5(&Hdf5Plugin::create_wiresens, path, shape);
  if (!writer) return writer.error();
  return support::write_all(**writer, frames);
}

void expect_round_trip(const std::vector<RawFrame>& frames, FrameShape shape) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(write_file(folder.file("f.hdf5"), shape, frames));
  const auto reader = by_hdf5(&Hdf5Plugin::open_wiresens, folder.file("f.hdf5"), kAnyShape);
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ((*reader)->shape(), shape);
  support::expect_same_frames(**reader, frames);
}

TEST(WiresensHdf5, gives_back_counts_and_microseconds) {
  Random random(1);
  std::vector<RawFrame> frames;
  for (int i = 0; i < 500; ++i) {
    const auto micros =
        std::chrono::microseconds(1'700'000'000'000'000 + static_cast<std::int64_t>(random.below(1'000'000'000'000)));
    frames.push_back(frame_at(micros, {}));
    for (int taxel = 0; taxel < 12; ++taxel) frames.back().counts.push_back(static_cast<float>(random.below(4096)));
  }
  frames[3].counts[0] = -16777216.0F;
  expect_round_trip(frames, {3, 4});
}

TEST(WiresensHdf5, gives_back_frames_of_time_0_and_no_frames) {
  expect_round_trip({frame_at(Nanos(0), {0, 0}), frame_at(Nanos(0), {0, 0})}, {1, 2});
  expect_round_trip({}, {1, 2});
}

TEST(WiresensHdf5, holds_whole_counts_only) {
  const support::TemporaryFolder folder;
  for (const auto& [count, text] :
       {std::pair(1.5F, "1.5"), std::pair(std::nanf(""), "nan"), std::pair(3e9F, "3e+09")}) {
    const Status written =
        write_file(folder.file("f.hdf5"), {1, 2}, {frame_at(Nanos(0), {1, 2}), frame_at(Nanos(1), {1, count})});
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().message, std::string("frame 1 has a count of ") + text +
                                           " at r0c1, and WiReSens files hold whole counts; write another format");
  }
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(WiresensHdf5, leaves_nothing_behind_where_the_disk_is_full) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("f.hdf5");
  const std::vector<RawFrame> frames = support::random_frames(2, 300, 256);
  for (const rlim_t size : {0U, 1000U, 10'000U, 100'000U, 150'000U}) {
    EXPECT_EQ(support::write_within(size, path, [&] { return write_file(path, {16, 16}, frames); }), 1) << size;
    EXPECT_EQ(folder.file_count(), 0U);
  }
}

}  // namespace
}  // namespace dermis::bytes::recordings
