// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/websocket/file_on_its_way.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/temporary_folder.hpp"

namespace dermis::out::websocket {
namespace {

TEST(FileOnItsWay, comes_in_pieces_that_are_the_file) {
  const support::TemporaryFolder folder;
  std::string content(2 * FileOnItsWay::kPieceBytes + 17, '\0');
  for (std::size_t i = 0; i < content.size(); ++i) content[i] = static_cast<char>(i % 251);
  support::write_bytes(folder.file("a.mcap"), content);
  FileOnItsWay file;
  ASSERT_TRUE(file.open(folder.file("a.mcap")));
  EXPECT_EQ(file.size(), content.size());
  std::string came;
  while (file.read_piece()) came.append(file.piece().begin(), file.piece().end());
  EXPECT_EQ(came, content);
}

TEST(FileOnItsWay, is_as_long_as_it_was_when_it_was_opened) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("a.mcap"), "first");
  FileOnItsWay file;
  ASSERT_TRUE(file.open(folder.file("a.mcap")));
  std::ofstream(folder.file("a.mcap"), std::ios::app) << "second";
  ASSERT_TRUE(file.read_piece());
  EXPECT_EQ(std::string(file.piece().begin(), file.piece().end()), "first");
  EXPECT_FALSE(file.read_piece());
}

TEST(FileOnItsWay, is_no_link_and_no_folder) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("a.mcap"), "secret");
  std::filesystem::create_symlink("a.mcap", folder.file("link.mcap"));
  EXPECT_FALSE(FileOnItsWay().open(folder.file("link.mcap")));
  EXPECT_FALSE(FileOnItsWay().open(folder.file("")));
  EXPECT_FALSE(FileOnItsWay().open(folder.file("none.mcap")));
}

}  // namespace
}  // namespace dermis::out::websocket
