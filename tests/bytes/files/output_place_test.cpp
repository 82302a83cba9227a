// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/output_place.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

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

TEST(OutputPlace, an_unfinished_file_goes_or_takes_its_place) {
  const support::TemporaryFolder folder;
  const std::string target = folder.file("new");
  { const Result<OutputPlace> dropped = open_output(target); }
  EXPECT_EQ(folder.file_count(), 0U);
  Result<OutputPlace> place = open_output(target);
  ASSERT_TRUE(place);
  ASSERT_TRUE(place->unfinished.take_place_of(target));
  EXPECT_FALSE(place->unfinished.exists());
  ::close(place->descriptor);
  EXPECT_EQ(folder.file_count(), 1U);
  EXPECT_TRUE(std::filesystem::exists(target));
}

TEST(OutputPlaceDeathTest, unfinished_files_are_removed_before_the_process_ends) {
  const support::TemporaryFolder folder;
  const auto end_at_once = [&] {
    const Result<OutputPlace> begun = open_output(folder.file("new"));
    remove_unfinished_files();
    ::_exit(begun && folder.file_count() == 0 ? 0 : 1);
  };
  EXPECT_EXIT(end_at_once(), testing::ExitedWithCode(0), "");
}

/// The number of a process that has ended.
pid_t ended_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

std::string temporary_of(const std::string& target, pid_t process) {
  return target + "." + std::to_string(process) + ".0.tmp";
}

TEST(OutputPlace, removes_what_killed_processes_have_left_of_the_same_target) {
  const support::TemporaryFolder folder;
  const std::string target = folder.file("model");
  const std::string left_over = temporary_of(target, ended_process());
  const std::string of_my_number = temporary_of(target, ::getpid());
  for (const std::string& path : {left_over, of_my_number}) support::write_bytes(path, "half");
  const Result<OutputPlace> place = open_output(target);
  ASSERT_TRUE(place);
  ::close(place->descriptor);
  EXPECT_FALSE(std::filesystem::exists(left_over));
  EXPECT_EQ(folder.file_count(), 1U) << "the one that was opened";
}

TEST(OutputPlace, leaves_what_living_processes_write_and_what_has_another_name) {
  const support::TemporaryFolder folder;
  const std::string target = folder.file("model");
  const std::string process = std::to_string(ended_process());
  const std::vector<std::string> kept{temporary_of(target, ::getppid()),
                                      temporary_of(target, 1),
                                      temporary_of(folder.file("m"), ended_process()),
                                      target + "." + process + ".tmp",
                                      target + "." + process + ".0",
                                      target + "." + process + ".0.tmp.tmp",
                                      target + "." + process + ".x.tmp",
                                      target + ".-" + process + ".0.tmp",
                                      target + ".0" + process + ".0.tmp",
                                      target + ".99999999999999999999.0.tmp",
                                      target + ".0.0.tmp",
                                      target + "x." + process + ".0.tmp"};
  for (const std::string& path : kept) support::write_bytes(path, "mine");
  std::filesystem::create_directory(target + "." + process + ".1.tmp");
  const Result<OutputPlace> place = open_output(target);
  ASSERT_TRUE(place);
  ::close(place->descriptor);
  for (const std::string& path : kept) EXPECT_TRUE(std::filesystem::exists(path)) << path;
  EXPECT_TRUE(std::filesystem::exists(target + "." + process + ".1.tmp"));
}

TEST(OutputPlace, leaves_what_it_has_begun_itself) {
  const support::TemporaryFolder folder;
  const Result<OutputPlace> first = open_output(folder.file("model"));
  const Result<OutputPlace> second = open_output(folder.file("model"));
  const Result<OutputPlace> by_another_path = open_output(folder.file("./model"));
  ASSERT_TRUE(first && second && by_another_path);
  for (const auto* place : {&*first, &*second, &*by_another_path}) {
    ::close(place->descriptor);
    EXPECT_TRUE(std::filesystem::exists(place->unfinished.path()));
  }
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
