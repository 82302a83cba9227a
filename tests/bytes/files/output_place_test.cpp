// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/output_place.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "dermis/bytes/files/input.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

TEST(OutputPlace, a_new_file_stands_beside_its_target) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("out"), "old");
  const Result<OutputPlace> place = open_output(folder.file("out"));
  ASSERT_TRUE(place);
  EXPECT_EQ(write_all(place->descriptor, bytes_of("new")), 0);
  EXPECT_EQ(write_all(place->descriptor, bytes_of("N"), 0), 0);
  ::close(place->descriptor);
  EXPECT_EQ(std::filesystem::path(place->unfinished.path()).parent_path(),
            std::filesystem::path(place->target).parent_path());
  EXPECT_EQ(support::read_bytes(place->unfinished.path()), "New");
  EXPECT_EQ(support::read_bytes(folder.file("out")), "old");
}

TEST(OutputPlace, behind_a_link_is_the_file_and_not_the_link) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("real"), "old");
  std::filesystem::create_symlink(folder.file("real"), folder.file("link"));
  const Result<OutputPlace> place = open_output(folder.file("link"));
  ASSERT_TRUE(place);
  ::close(place->descriptor);
  EXPECT_EQ(place->target, std::filesystem::canonical(folder.file("real")).string());
}

TEST(OutputPlace, a_name_that_is_claimed_is_opened_once_by_whoever_claimed_it) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec");
  ASSERT_TRUE(claim_output(path, EarlierFile::stays_unread));
  EXPECT_FALSE(UnfinishedFile::begin(path));
  ASSERT_TRUE(claim_output(path, EarlierFile::stays_unread));
  const Result<OutputPlace> place = open_output(path);
  ASSERT_TRUE(place) << place.error().message;
  ::close(place->descriptor);
  EXPECT_FALSE(open_output(path));
}

TEST(OutputPlace, a_claim_outlives_a_file_or_a_link_that_appears_there) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("elsewhere"), "another's");
  for (const bool is_link : {false, true}) {
    const std::string path = folder.file(is_link ? "linked" : "rec");
    ASSERT_TRUE(claim_output(path, EarlierFile::stays_unread));
    if (is_link) std::filesystem::create_symlink(folder.file("elsewhere"), path);
    if (!is_link) support::write_bytes(path, "another's");
    Result<OutputPlace> place = open_output(path);
    ASSERT_TRUE(place) << place.error().message;
    ::close(place->descriptor);
    const Result<Placed> placed = place->unfinished.take_place();
    ASSERT_TRUE(placed);
    EXPECT_FALSE(placed->told);
    EXPECT_EQ(support::read_bytes(path), "another's");
  }
}

TEST(OutputPlace, a_claim_that_is_released_leaves_nothing) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(claim_output(folder.file("rec"), EarlierFile::stays_unread));
  EXPECT_EQ(folder.file_count(), 1U);
  release_claims();
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(OutputPlace, a_file_that_will_be_replaced_is_not_readable_by_any_name) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("lay.toml");
  const std::string link = folder.file("link");
  const std::string hard_link = folder.file("hard_link");
  for (const char* const name : {"lay.toml", "other.toml"}) support::write_bytes(folder.file(name), "[layout]");
  std::filesystem::create_symlink(path, link);
  std::filesystem::create_hard_link(path, hard_link);
  ASSERT_TRUE(claim_output(link, EarlierFile::stays_unread));
  for (const std::string& name : {path, link, hard_link}) {
    const Status readable = check_readable(name);
    ASSERT_FALSE(readable) << name;
    EXPECT_EQ(readable.error().message,
              "'" + name + "' is read, and would be replaced by the output; name another output");
    EXPECT_FALSE(open_input(name));
  }
  EXPECT_TRUE(check_readable(folder.file("other.toml")));
  release_claims();
  EXPECT_TRUE(check_readable(path));
}

TEST(OutputPlace, an_earlier_model_may_be_read) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("model"), "old");
  ASSERT_TRUE(claim_output(folder.file("model"), EarlierFile::may_be_read));
  EXPECT_TRUE(check_readable(folder.file("model")));
  release_claims();
}

TEST(OutputPlace, what_is_no_regular_file_is_written_directly) {
  const Result<OutputPlace> place = open_output("/dev/null");
  ASSERT_TRUE(place);
  EXPECT_FALSE(place->unfinished.exists());
  EXPECT_EQ(write_all(place->descriptor, bytes_of("gone")), 0);
  ::close(place->descriptor);
}

TEST(OutputPlace, a_place_that_is_not_there_is_named) {
  const Result<OutputPlace> place = open_output("/nowhere/out");
  ASSERT_FALSE(place);
  EXPECT_EQ(place.error().message, "cannot write '/nowhere/out': No such file or directory");
}

}  // namespace
}  // namespace dermis::bytes::files
