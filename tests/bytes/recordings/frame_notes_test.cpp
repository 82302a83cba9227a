// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/frame_notes.hpp"

#include <gtest/gtest.h>

#include <string>

#include "dermis/bytes/files/origin_toml.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

void write(const std::string& path, const FrameNotes& notes) {
  const auto sink = create_frames(path, {1, 2}, notes);
  ASSERT_TRUE(sink);
  RawFrame frame;
  frame.counts = {1.0F, 2.0F};
  ASSERT_TRUE((*sink)->write(frame));
  ASSERT_TRUE((*sink)->commit());
}

TEST(FrameNotes, come_back_from_the_formats_that_have_a_place_for_them) {
  const support::TemporaryFolder folder;
  const FrameNotes notes = {"palm", "[array]\n", "fnv1a64:12", "sim:multitouch?seed=2"};
  for (const std::string name : {"it.mcap", "it.h5"}) {
    write(folder.file(name), notes);
    EXPECT_EQ(*read_frame_notes(folder.file(name)), notes) << name;
  }
}

TEST(FrameNotes, of_a_table_tell_the_simulation_that_wrote_it) {
  const support::TemporaryFolder folder;
  write(folder.file("frames.csv"), {});
  EXPECT_EQ(*read_frame_notes(folder.file("frames.csv")), FrameNotes{});
  ASSERT_TRUE(files::write_origin(folder.file("frames.csv"), "sim:multitouch"));
  EXPECT_EQ(*read_frame_notes(folder.file("frames.csv")), FrameNotes{.simulation = "sim:multitouch"});
}

}  // namespace
}  // namespace dermis::bytes::recordings
