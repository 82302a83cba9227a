// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/atomic_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <mutex>
#include <utility>
#include <vector>

#include "support/disk_calls.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {

namespace {

TEST(AtomicFile, appears_complete_on_commit) {
  const support::TemporaryFolder folder;
  Result<AtomicFile> file = AtomicFile::create(folder.file("a.csv"));
  ASSERT_TRUE(file);
  file->write("one,");
  file->write("two\n");
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.csv")));
  EXPECT_TRUE(file->commit());
  EXPECT_EQ(support::read_bytes(folder.file("a.csv")), "one,two\n");
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(AtomicFile, appears_when_its_bytes_are_on_the_disk_and_has_its_name_kept) {
  const support::TemporaryFolder folder;
  Result<AtomicFile> file = AtomicFile::create(folder.file("a.csv"));
  ASSERT_TRUE(file);
  file->write("one");
  static_cast<void>(support::take_disk_calls());
  EXPECT_TRUE(file->commit());
  EXPECT_EQ(support::take_disk_calls(), (std::vector<std::string>{"bytes", "rename", "names"}));
}

TEST(AtomicFile, writes_more_than_its_buffer) {
  const support::TemporaryFolder folder;
  const std::string piece(700'000, 'x');
  Result<AtomicFile> file = AtomicFile::create(folder.file("a"));
  ASSERT_TRUE(file);
  for (int i = 0; i < 5; ++i) file->write(piece);
  EXPECT_TRUE(file->commit());
  EXPECT_EQ(support::read_bytes(folder.file("a")), std::string(3'500'000, 'x'));
}

TEST(AtomicFile, leaves_target_untouched_and_no_temporary_file_without_commit) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("a"), "old");
  {
    Result<AtomicFile> file = AtomicFile::create(folder.file("a"));
    ASSERT_TRUE(file);
    AtomicFile moved = *std::move(file);
    moved.write("new");
  }
  EXPECT_EQ(support::read_bytes(folder.file("a")), "old");
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(AtomicFile, replaces_the_file_behind_a_symbolic_link) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("real"), "old");
  std::filesystem::create_symlink("real", folder.file("link"));
  Result<AtomicFile> file = AtomicFile::create(folder.file("link"));
  ASSERT_TRUE(file);
  file->write("new");
  EXPECT_TRUE(file->commit());
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
  EXPECT_EQ(support::read_bytes(folder.file("real")), "new");
}

TEST(AtomicFile, names_the_file_where_the_folder_is_missing) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("missing/a");
  const Result<AtomicFile> file = AtomicFile::create(path);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().kind, ErrorKind::failed);
  EXPECT_EQ(file.error().message, "cannot write '" + path + "': No such file or directory");
}

TEST(AtomicFile, names_a_folder_given_as_a_file) {
  const support::TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("a"));
  const Result<AtomicFile> file = AtomicFile::create(folder.file("a"));
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().message, "cannot write '" + folder.file("a") + "': Is a directory");
}

TEST(AtomicFile, reports_a_full_device) {
  Result<AtomicFile> file = AtomicFile::create("/dev/full");
  ASSERT_TRUE(file);
  file->write("x");
  const Status committed = file->commit();
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().kind, ErrorKind::failed);
  EXPECT_EQ(committed.error().message, "cannot write '/dev/full': No space left on device");
  EXPECT_FALSE(std::filesystem::is_regular_file("/dev/full"));
}

TEST(AtomicFile, tells_the_first_error_before_commit) {
  Result<AtomicFile> file = AtomicFile::create("/dev/full");
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->status());
  file->write(std::string(2'000'000, 'x'));
  EXPECT_FALSE(file->status());
}

TEST(AtomicFile, writes_into_a_pipe_directly) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("pipe");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const pid_t reader = ::fork();
  if (reader == 0) ::_exit(support::read_bytes(path) == "x" ? 0 : 1);
  {
    Result<AtomicFile> file = AtomicFile::create(path);
    ASSERT_TRUE(file);
    file->write("x");
    EXPECT_TRUE(file->commit());
  }
  int status = 0;
  ASSERT_EQ(::waitpid(reader, &status, 0), reader);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(std::filesystem::is_fifo(path));
}

/// In a child process, whose files may not grow beyond 64 KiB: 0 where the write fails as it should.
int write_too_much(const std::string& path) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{65536, 65536};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return 1;
  file->write(std::string(200'000, 'x'));
  const Status committed = file->commit();
  if (committed || committed.error().kind != ErrorKind::failed) return 2;
  return committed.error().message == "cannot write '" + path + "': File too large" ? 0 : 3;
}

TEST(AtomicFile, leaves_target_untouched_where_the_disk_is_full) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("a"), "old");
  const pid_t child = ::fork();
  if (child == 0) ::_exit(write_too_much(folder.file("a")));
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(support::read_bytes(folder.file("a")), "old");
  EXPECT_EQ(folder.file_count(), 1U);
}

}  // namespace
}  // namespace dermis::bytes::files
