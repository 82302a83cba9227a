// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/content_hash.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

std::string hash_of(std::string_view bytes) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("a"), bytes);
  const Result<std::string> hash = content_hash(folder.file("a"));
  return hash ? *hash : hash.error().message;
}

// Vectors of the authors: http://www.isthe.com/chongo/src/fnv/test_fnv.c
TEST(ContentHash, agrees_with_the_published_vectors) {
  EXPECT_EQ(hash_of(""), "fnv1a64:cbf29ce484222325");
  EXPECT_EQ(hash_of("a"), "fnv1a64:af63dc4c8601ec8c");
  EXPECT_EQ(hash_of("foobar"), "fnv1a64:85944171f73967e8");
}

TEST(ContentHash, does_not_depend_on_the_pieces) {
  ContentHash hash;
  hash.add("foo");
  hash.add("");
  hash.add("bar");
  EXPECT_EQ(hash.text(), "fnv1a64:85944171f73967e8");
}

TEST(ContentHash, covers_files_larger_than_one_piece) {
  const std::string bytes(3'000'000, 'x');
  std::string changed = bytes;
  changed.back() = 'y';
  EXPECT_NE(hash_of(bytes), hash_of(changed));
}

TEST(ContentHash, names_a_missing_file) {
  const Result<std::string> hash = content_hash("/no/such/file");
  ASSERT_FALSE(hash);
  EXPECT_EQ(hash.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(hash.error().message, "cannot open '/no/such/file': No such file or directory");
}

}  // namespace
}  // namespace dermis::bytes::files
