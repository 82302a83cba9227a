// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/input.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

TEST(Input, a_file_is_read_whole_and_never_beyond_its_limit) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("a.bin");
  const std::string bytes(3'000'000, 'a');
  support::write_bytes(path, bytes);
  const Result<std::string> whole = read_file(path, bytes.size());
  ASSERT_TRUE(whole);
  EXPECT_EQ(*whole, bytes);
  const Result<std::string> longer = read_file(path, bytes.size() - 1);
  ASSERT_FALSE(longer);
  EXPECT_EQ(longer.error().message, path + ": is larger than 2999999 bytes");
}

TEST(Input, first_bytes_are_those_that_there_are) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("a.bin");
  support::write_bytes(path, "abcdef");
  EXPECT_EQ(first_bytes_of(path, 4), "abcd");
  EXPECT_EQ(first_bytes_of(path, 100), "abcdef");
  EXPECT_EQ(first_bytes_of(folder.file("absent"), 4), "");
  EXPECT_EQ(first_bytes_of(testing::TempDir(), 4), "");
  EXPECT_EQ(first_bytes_of("/dev/zero", 4), "") << "would be taken from who reads it";
}

TEST(Input, what_cannot_be_opened_is_named) {
  const support::TemporaryFolder folder;
  const auto absent = open_input(folder.file("absent"));
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(absent.error().message, "cannot open '" + folder.file("absent") + "': No such file or directory");
  EXPECT_EQ(open_input(testing::TempDir()).error().message, "cannot open '" + testing::TempDir() + "': Is a directory");
}

}  // namespace
}  // namespace dermis::bytes::files
