// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/unfinished_file.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBusy = " is being written by another; wait for its end, or name another file";

std::string beside(const std::string& target) {
  return target + ".dermis.tmp";
}

/// A process that does this, and then holds what it has until it is killed.
class OtherProcess {
 public:
  explicit OtherProcess(const std::function<bool()>& work) {
    int done[2];
    if (::pipe(done) != 0) return;
    process_ = ::fork();
    if (process_ == 0) {
      const bool is_well = work();
      if (!is_well || ::write(done[1], "1", 1) != 1) ::_exit(1);
      while (true) ::pause();
    }
    ::close(done[1]);
    char told = 0;
    is_ready_ = ::read(done[0], &told, 1) == 1;
    ::close(done[0]);
  }
  OtherProcess(const OtherProcess&) = delete;
  OtherProcess& operator=(const OtherProcess&) = delete;
  ~OtherProcess() { kill(); }

  [[nodiscard]] bool is_ready() const { return is_ready_; }
  void kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(std::exchange(process_, 0), nullptr, 0);
  }

 private:
  pid_t process_ = 0;
  bool is_ready_ = false;
};

TEST(UnfinishedFile, goes_or_takes_its_place) {
  const support::TemporaryFolder folder;
  const std::string target = folder.file("new");
  { ASSERT_TRUE(UnfinishedFile::begin(target)); }
  EXPECT_EQ(folder.file_count(), 0U);
  Result<UnfinishedFile> file = UnfinishedFile::begin(target);
  ASSERT_TRUE(file);
  EXPECT_EQ(file->path(), beside(target));
  EXPECT_TRUE(UnfinishedFile::is_begun(target));
  const Result<Placed> placed = file->take_place();
  ASSERT_TRUE(placed && placed->told);
  EXPECT_EQ(placed->path, target);
  EXPECT_FALSE(file->exists());
  EXPECT_FALSE(UnfinishedFile::is_begun(target));
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(UnfinishedFile, replaces_what_stood_there_when_it_began) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("rec"), "old");
  Result<UnfinishedFile> file = UnfinishedFile::begin(folder.file("rec"));
  ASSERT_TRUE(file);
  const Result<Placed> placed = file->take_place();
  ASSERT_TRUE(placed && placed->told);
  EXPECT_EQ(support::read_bytes(folder.file("rec")), "");
}

TEST(UnfinishedFile, replaces_nothing_that_has_appeared_since) {
  for (const bool was_there : {false, true}) {
    const support::TemporaryFolder folder;
    const std::string target = folder.file("rec.csv");
    if (was_there) support::write_bytes(target, "old");
    Result<UnfinishedFile> file = UnfinishedFile::begin(target);
    ASSERT_TRUE(file);
    support::write_bytes(folder.file("other"), "another's");
    fs::rename(folder.file("other"), target);
    const Result<Placed> placed = file->take_place();
    ASSERT_TRUE(placed);
    ASSERT_FALSE(placed->told);
    EXPECT_EQ(placed->told.error().message,
              "'" + target + "' is another's by now, and stays; what was written is '" + placed->path + "'");
    EXPECT_EQ(support::read_bytes(target), "another's");
    EXPECT_TRUE(placed->path.starts_with(folder.file("rec-")) && placed->path.ends_with(".csv")) << placed->path;
    EXPECT_EQ(folder.file_count(), 2U);
  }
}

TEST(UnfinishedFile, of_a_folder_replaces_an_empty_one_and_no_other) {
  const support::TemporaryFolder folder;
  const std::string target = folder.file("set");
  fs::create_directory(target);
  Result<UnfinishedFile> first = UnfinishedFile::begin_folder(target);
  ASSERT_TRUE(first);
  support::write_bytes(first->path() + "/page", "first");
  Result<Placed> placed = first->take_place();
  ASSERT_TRUE(placed && placed->told);
  Result<UnfinishedFile> second = UnfinishedFile::begin_folder(target);
  ASSERT_TRUE(second);
  support::write_bytes(second->path() + "/page", "second");
  placed = second->take_place();
  ASSERT_TRUE(placed);
  EXPECT_FALSE(placed->told);
  EXPECT_EQ(support::read_bytes(target + "/page"), "first");
  EXPECT_EQ(support::read_bytes(placed->path + "/page"), "second");
}

TEST(UnfinishedFile, is_one_of_a_target) {
  const support::TemporaryFolder folder;
  const Result<UnfinishedFile> first = UnfinishedFile::begin(folder.file("model"));
  ASSERT_TRUE(first);
  for (const char* const name : {"model", "./model"}) {
    const Result<UnfinishedFile> second = UnfinishedFile::begin(folder.file(name));
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().message, "'" + folder.file(name) + "'" + kBusy);
  }
  EXPECT_TRUE(fs::exists(first->path()));
}

TEST(UnfinishedFile, is_refused_while_another_process_writes_the_target) {
  const support::TemporaryFolder folder;
  const std::string target = folder.file("rec");
  Result<UnfinishedFile> of_other = failed("");
  OtherProcess other([&] {
    of_other = UnfinishedFile::begin(target);
    return of_other.has_value();
  });
  ASSERT_TRUE(other.is_ready());
  const Result<UnfinishedFile> refused = UnfinishedFile::begin(target);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "'" + target + "'" + kBusy);
  EXPECT_TRUE(fs::exists(beside(target)));
  other.kill();
  EXPECT_TRUE(UnfinishedFile::begin(target));
}

TEST(UnfinishedFile, is_refused_while_the_target_grows_in_its_place) {
  const support::TemporaryFolder folder;
  const std::string target = folder.file("rec");
  OtherProcess other([&] {
    Result<UnfinishedFile> file = UnfinishedFile::begin(target);
    const int descriptor = file ? file->duplicate_descriptor() : -1;
    return descriptor >= 0 && file->take_place();
  });
  ASSERT_TRUE(other.is_ready());
  EXPECT_FALSE(UnfinishedFile::begin(target));
  other.kill();
  EXPECT_TRUE(UnfinishedFile::begin(target));
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(UnfinishedFile, removes_what_killed_processes_have_left_in_the_folder) {
  const support::TemporaryFolder folder;
  Result<UnfinishedFile> file = failed("");
  Result<UnfinishedFile> set = failed("");
  OtherProcess other([&] {
    file = UnfinishedFile::begin(folder.file("rec"));
    set = UnfinishedFile::begin_folder(folder.file("set"));
    if (!file || !set) return false;
    support::write_bytes(set->path() + "/page", "half");
    return true;
  });
  ASSERT_TRUE(other.is_ready());
  other.kill();
  ASSERT_TRUE(fs::exists(beside(folder.file("rec"))) && fs::exists(beside(folder.file("set")) + "/page"));
  const Result<UnfinishedFile> mine = UnfinishedFile::begin(folder.file("other"));
  ASSERT_TRUE(mine);
  EXPECT_FALSE(fs::exists(beside(folder.file("rec"))));
  EXPECT_FALSE(fs::exists(beside(folder.file("set"))));
}

TEST(UnfinishedFile, leaves_what_others_write_and_what_has_another_name) {
  const support::TemporaryFolder folder;
  const std::vector<std::string> kept{"model.tmp", "model.dermis.tmp.csv", "model.1234.0.tmp", "dermis.tmp"};
  for (const std::string& name : kept) support::write_bytes(folder.file(name), "mine");
  support::write_bytes(folder.file("notes"), "mine");
  fs::create_symlink(folder.file("notes"), folder.file("link.dermis.tmp"));
  Result<UnfinishedFile> of_other = failed("");
  const OtherProcess other([&] {
    of_other = UnfinishedFile::begin(folder.file("rec"));
    return of_other.has_value();
  });
  ASSERT_TRUE(other.is_ready());
  const Result<UnfinishedFile> mine = UnfinishedFile::begin(folder.file("model"));
  ASSERT_TRUE(mine);
  for (const std::string& name : kept) EXPECT_TRUE(fs::exists(folder.file(name))) << name;
  EXPECT_TRUE(fs::is_symlink(folder.file("link.dermis.tmp")));
  EXPECT_TRUE(fs::exists(beside(folder.file("rec"))));
}

TEST(UnfinishedFileDeathTest, unfinished_files_are_removed_before_the_process_ends) {
  const support::TemporaryFolder folder;
  const auto end_at_once = [&] {
    const Result<UnfinishedFile> begun = UnfinishedFile::begin(folder.file("new"));
    remove_unfinished_files();
    ::_exit(begun && folder.file_count() == 0 ? 0 : 1);
  };
  EXPECT_EXIT(end_at_once(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace dermis::bytes::files
