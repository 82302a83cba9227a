// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/kept_copy.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

using std::chrono::seconds;
using std::chrono::system_clock;

constexpr system_clock::time_point kTime{seconds(1'795'256'100)};

TEST(TimeStamp, is_the_date_and_the_time_in_utc) {
  EXPECT_EQ(time_stamp(kTime), "20261121-101500");
}

TEST(KeptCopy, has_the_bytes_of_the_file_and_the_time_in_its_name) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("chest.safetensors"), "model");
  const Result<std::string> copy = keep_copy(folder.file("chest.safetensors"), kTime);
  ASSERT_TRUE(copy) << copy.error().message;
  EXPECT_EQ(*copy, folder.file("chest-before-20261121-101500.safetensors"));
  EXPECT_EQ(support::read_bytes(*copy), "model");
  EXPECT_EQ(support::read_bytes(folder.file("chest.safetensors")), "model");
}

TEST(KeptCopy, takes_the_place_of_none_before_it) {
  const support::TemporaryFolder folder;
  for (const char* const content : {"first", "second", "third"}) {
    support::write_bytes(folder.file("m"), content);
    ASSERT_TRUE(keep_copy(folder.file("m"), kTime));
  }
  EXPECT_EQ(support::read_bytes(folder.file("m-before-20261121-101500")), "first");
  EXPECT_EQ(support::read_bytes(folder.file("m-before-20261121-101500-2")), "second");
  EXPECT_EQ(support::read_bytes(folder.file("m-before-20261121-101500-3")), "third");
}

TEST(KeptCopy, names_a_file_that_is_missing) {
  const Result<std::string> copy = keep_copy("/no/such/file", kTime);
  ASSERT_FALSE(copy);
  EXPECT_EQ(copy.error().message, "cannot open '/no/such/file': No such file or directory");
}

}  // namespace
}  // namespace dermis::bytes::files
