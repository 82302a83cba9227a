// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/file_kind.hpp"

#include <gtest/gtest.h>

namespace dermis::bytes::files {
namespace {

using namespace std::string_view_literals;  // NOLINT(google-build-using-namespace): the literals only

TEST(FileKind, is_told_by_the_first_bytes) {
  EXPECT_EQ(kind_of("\x89MCAP0\r\n\x01"sv), kMcapKind);
  EXPECT_EQ(kind_of("\x89HDF\r\n\x1a\n"sv), kHdf5Kind);
  EXPECT_EQ(kind_of("\x93NUMPY\x01\x00"sv), kNpyKind);
  EXPECT_EQ(kind_of("PK\x03\x04\x14"sv), kZipKind);
  EXPECT_EQ(kind_of("\x89PNG\r\n\x1a\n"sv), "a PNG picture");
  EXPECT_EQ(kind_of("\x48\x00\x00\x00\x00\x00\x00\x00{\"a\":"sv), kSafetensorsKind);
  EXPECT_EQ(kind_of("# made by hand\r\n\n[array]\r\nrows = 4\n"), kTomlKind);
  EXPECT_EQ(kind_of("\xEF\xBB\xBFtime_s,r0c0\n0,1\n"), kTableKind);
}

TEST(FileKind, is_not_told_by_what_any_file_may_begin_with) {
  EXPECT_EQ(kind_of(""), "");
  EXPECT_EQ(kind_of("12345678"), "");
  EXPECT_EQ(kind_of("abcdefgh{\"a\":"), "");
  EXPECT_EQ(kind_of("rows = 4, or so\n"), "");
  EXPECT_EQ(kind_of("a,\x01\n"), "");
  EXPECT_EQ(kind_of("[1 2 3]\n"), "");
}

TEST(FileKind, is_said_to_who_wanted_another_one) {
  EXPECT_EQ(wrong_kind("\x89MCAP0\r\n", kSafetensorsKind), "is an MCAP recording, not a safetensors file");
  EXPECT_FALSE(wrong_kind("\x89MCAP0\r\n", kMcapKind));
  EXPECT_FALSE(wrong_kind("12345678", kMcapKind));
}

}  // namespace
}  // namespace dermis::bytes::files
