// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/array_folder.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "support/temporary_folder.hpp"

namespace dermis::live::sources {
namespace {

namespace fs = std::filesystem;
using support::TemporaryFolder;

class ArrayFolderTest : public testing::Test {
 protected:
  void SetUp() override { write("array.toml", ""); }

  [[nodiscard]] std::string path(const std::string& name = {}) const { return folder_.file("mat/" + name); }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(folder_.file("mat"));
    std::ofstream(path(name)) << text;
  }
  /// A file that was written so many seconds ago.
  void write_before(const std::string& name, int seconds) const {
    write(name, "");
    fs::last_write_time(path(name), fs::file_time_type::clock::now() - std::chrono::seconds(seconds));
  }
  [[nodiscard]] Result<ArrayFolder> read() const { return read_array_folder(folder_.file("mat")); }
  [[nodiscard]] std::string from_after(const std::string& uri) const {
    EXPECT_TRUE(write_array_source(folder_.file("mat"), SourceName::parse(uri).value()));
    return read().value().from;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(ArrayFolderTest, has_its_newest_model) {
  write_before("mat-2.safetensors", 10);
  write_before("mat-1.safetensors", 5);
  write_before("mat-3.safetensors", 20);
  const Result<ArrayFolder> folder = read();
  ASSERT_TRUE(folder) << folder.error().message;
  EXPECT_EQ(folder->model, path("mat-1.safetensors"));
  EXPECT_TRUE(folder->is_calibrated());
}

TEST_F(ArrayFolderTest, without_a_model_is_its_description_and_with_places_its_suit) {
  EXPECT_EQ(read()->model, path("array.toml"));
  EXPECT_EQ(read()->from, "");
  write("array.suit.toml", "");
  EXPECT_EQ(read()->model, path("array.suit.toml"));
  EXPECT_TRUE(read()->is_suit());
  EXPECT_FALSE(read()->is_calibrated());
}

TEST_F(ArrayFolderTest, knows_the_source_that_was_written) {
  for (const std::string uri : {"sim:idle?rate=100", "tcp://192.168.4.1:3333", "udp://0.0.0.0:9000?rows=3&cols=4",
                                "serial:///dev/no_such_tty?baud=9600"}) {
    EXPECT_EQ(from_after(uri), uri);
  }
}

TEST_F(ArrayFolderTest, keeps_its_layout_where_it_lies) {
  write("layout.toml", "[layout]\nrows = 2\ncols = 2\nline = \"{values}\"\n");
  EXPECT_EQ(from_after("serial:///dev/no_such_tty?baud=9600&layout=" + path("layout.toml")),
            "serial:///dev/no_such_tty?baud=9600&layout=" + path("layout.toml"));
  std::ifstream file(path("source.toml"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find("layout = \"layout.toml\""), std::string::npos) << text;
}

TEST_F(ArrayFolderTest, with_a_source_that_is_wrong_is_refused) {
  write("source.toml", "fromm = \"sim:idle\"\n");
  ASSERT_FALSE(read());
  EXPECT_NE(read().error().message.find("fromm"), std::string::npos) << read().error().message;
}

TEST_F(ArrayFolderTest, is_none_without_a_description) {
  EXPECT_TRUE(is_array_folder(fs::path(path("x")).parent_path().string()));
  fs::remove(path("array.toml"));
  EXPECT_FALSE(is_array_folder(fs::path(path("x")).parent_path().string()));
  EXPECT_FALSE(read());
}

TEST_F(ArrayFolderTest, finds_its_source_by_frames_of_its_shape) {
  EXPECT_EQ(from_after("sim:idle?rate=100&rows=3&cols=4"), "sim:idle?rate=100&rows=3&cols=4");
  const Result<SourceName> found = find_source(*read(), {3, 4}, {});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->text, "sim:idle?rate=100&rows=3&cols=4");
  const Result<SourceName> other = find_source(*read(), {4, 4}, {});
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("4x4"), std::string::npos) << other.error().message;
}

}  // namespace
}  // namespace dermis::live::sources
