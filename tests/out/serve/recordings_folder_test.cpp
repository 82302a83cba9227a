// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/recordings_folder.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

using support::TemporaryFolder;

TEST(RecordingsFolder, lists_its_recordings_the_newest_first) {
  const TemporaryFolder folder;
  for (const char* name : {"old.mcap", "new.mcap", "frames.csv", "secret.toml"}) {
    support::write_bytes(folder.file(name), name);
  }
  const auto now = std::filesystem::file_time_type::clock::now();
  std::filesystem::last_write_time(folder.file("old.mcap"), now - std::chrono::hours(1));
  std::filesystem::create_directory(folder.file("folder.mcap"));
  std::filesystem::create_symlink("/etc/passwd", folder.file("link.mcap"));
  const RecordingsFolder recordings(folder.file("next.mcap"));
  const std::vector<SavedFile> files = recordings.recordings();
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].name, "new.mcap");
  EXPECT_EQ(files[1].name, "old.mcap");
  EXPECT_EQ(files[0].bytes, 8U);
  EXPECT_NEAR(static_cast<double>(files[0].changed_s - files[1].changed_s), 3600.0, 5.0);
}

TEST(RecordingsFolder, finds_its_recordings_and_nothing_outside_of_it) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("in"));
  support::write_bytes(folder.file("in/a.mcap"), "a");
  support::write_bytes(folder.file("outside.mcap"), "b");
  std::filesystem::create_symlink("../outside.mcap", folder.file("in/link.mcap"));
  const RecordingsFolder recordings(folder.file("in/next.mcap"));
  EXPECT_EQ(*recordings.recording("a.mcap"), folder.file("in/a.mcap"));
  const std::string absolute = folder.file("outside.mcap");
  for (const std::string& name : {std::string("../outside.mcap"), absolute, std::string("link.mcap"), std::string(),
                                  std::string("none.mcap"), std::string("."), std::string("a.mcap\0", 7)}) {
    EXPECT_FALSE(recordings.recording(name)) << name;
  }
}

TEST(RecordingsFolder, names_no_file_that_is_there) {
  const TemporaryFolder folder;
  support::write_bytes(folder.file("a.mcap"), "a");
  std::filesystem::create_symlink("/nowhere", folder.file("b.mcap"));
  const RecordingsFolder recordings(folder.file("next.mcap"));
  EXPECT_EQ(*recordings.new_path("c", ".csv"), folder.file("c.csv"));
  EXPECT_EQ(recordings.new_path("a", ".mcap").error().message, "name: a.mcap is there already; choose another");
  EXPECT_FALSE(recordings.new_path("b", ".mcap")) << "a link that leads nowhere is there, too";
  EXPECT_EQ(RecordingsFolder("").path(), ".");
}

}  // namespace
}  // namespace dermis::out::serve
