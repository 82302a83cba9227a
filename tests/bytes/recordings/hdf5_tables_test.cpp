// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/hdf5_tables.hpp"

#include <gtest/gtest.h>

#include "dermis/bytes/recordings/frame_files.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

// tests/pypi/datasets_test.py reads tables and attributes by h5py.
TEST(Hdf5Tables, hold_the_rows_that_were_appended) {
  const support::TemporaryFolder folder;
  const auto file = Hdf5Tables::create(folder.file("t.h5"));
  ASSERT_TRUE(file);
  const Result<std::size_t> table = (*file)->add("/deep/group/table", Hdf5Tables::Number::float32, {2, 2});
  ASSERT_TRUE(table);
  const std::vector<float> values = {1, 2, 3, 4, 5, 6, 7, 8};
  ASSERT_TRUE((*file)->append(*table, 1, values.data()));
  ASSERT_TRUE((*file)->append(*table, 1, values.data() + 4));
  ASSERT_TRUE((*file)->set_text("/deep", "why", "a test"));
  ASSERT_TRUE((*file)->set_number("/deep/group/table", "rows", 2));
  ASSERT_TRUE((*file)->set_flag("/", "sim", false));
  ASSERT_TRUE((*file)->write_names("/mask/train", {"demo_9", "demo_10"}));
  EXPECT_FALSE((*file)->write_names("/mask/train", {"demo_9"})) << "it is there";
  ASSERT_TRUE((*file)->commit());

  const auto frames = open_frames(folder.file("t.h5") + "#/deep/group/table", {.rate_hz = 1.0});
  ASSERT_TRUE(frames) << frames.error().message;
  RawFrame frame;
  ASSERT_TRUE(*(*frames)->next(frame));
  ASSERT_TRUE(*(*frames)->next(frame));
  EXPECT_EQ(frame.counts, (std::vector<float>{5, 6, 7, 8}));
}

TEST(Hdf5Tables, leave_no_file_without_commit_and_say_what_cannot_be) {
  const support::TemporaryFolder folder;
  {
    const auto file = Hdf5Tables::create(folder.file("t.h5"));
    ASSERT_TRUE(file);
    ASSERT_TRUE((*file)->add("/table", Hdf5Tables::Number::int64, {}));
    EXPECT_FALSE((*file)->add("/table", Hdf5Tables::Number::uint8, {}));
    EXPECT_FALSE((*file)->set_number("/nobody", "rows", 2));
  }
  EXPECT_EQ(folder.file_count(), 0U);
}

}  // namespace
}  // namespace dermis::bytes::recordings
