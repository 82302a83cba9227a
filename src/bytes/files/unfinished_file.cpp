// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/unfinished_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "bytes/files/known_outputs.hpp"
#include "dermis/bytes/files/kept_copy.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".dermis.tmp";

/// Who removes what is left over holds its lock for a moment.
constexpr int kTries = 20;
constexpr std::chrono::milliseconds kBetweenTries{5};

UnfinishedFiles& unfinished_files() {
  return process_outputs().unfinished;
}

void remove_whole(const std::string& path) {
  std::error_code gone;
  fs::remove_all(path, gone);
}

bool is_same(const struct stat& one, const struct stat& other) {
  return one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

/// Whether the descriptor is of the file that has this name now.
bool is_named(int descriptor, const std::string& path) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(descriptor, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 && is_same(opened, named);
}

/// Removes what nobody holds the lock of.
void remove_left_over(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  const bool is_free = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  if (is_free && is_named(descriptor, path)) remove_whole(path);
  ::close(descriptor);
}

bool may_be_ours(const fs::path& path) {
  struct stat info {};
  return path.filename().string().ends_with(kEnding) && ::lstat(path.c_str(), &info) == 0 &&
         (S_ISREG(info.st_mode) || S_ISDIR(info.st_mode)) && info.st_uid == ::geteuid();
}

void tidy_folder_of(const std::string& target, UnfinishedFiles& files) {
  const fs::path parent = fs::path(target).parent_path();
  std::error_code error;
  const fs::path folder = fs::canonical(parent.empty() ? "." : parent, error);
  if (error || !files.tidied.insert(folder.string()).second) return;
  std::vector<std::string> left;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (may_be_ours(entry->path())) left.push_back(entry->path().string());
  }
  for (const std::string& path : left) remove_left_over(path);
}

/// A new one; -1 and errno where that cannot be.
int make_file(const std::string& path) {
  return ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

int make_folder(const std::string& path) {
  if (::mkdir(path.c_str(), 0777) != 0) return -1;
  return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

/// Locks a new one. False: another has taken it for left over, and removes it. Not every file system has locks.
bool lock(int descriptor, const std::string& path) {
  const bool is_others = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  return !is_others && is_named(descriptor, path);
}

/// Whether it is a recording, which takes its place while it grows, or locked by another program.
bool is_locked(const std::string& target) {
  const int descriptor = ::open(target.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool is_busy = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return is_busy;
}

Error is_being_written(const std::string& target) {
  return bad_input(in_quotes(target) + " is being written by another; wait for its end, or name another file");
}

/// Returns 0, or the errno: EEXIST where something has this name. Not every file system can refuse to replace it.
int rename_to_unused(const std::string& from, const std::string& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  if (::access(to.c_str(), F_OK) == 0) return EEXIST;
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

int rename_over(const std::string& from, const std::string& to) {
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

}  // namespace

UnfinishedFile::UnfinishedFile(std::string target, int lock)
    : target_(std::move(target)), path_(target_ + kEnding), lock_(lock), earlier_(id_of(target_)) {}

UnfinishedFile::UnfinishedFile(UnfinishedFile&& other) noexcept {
  *this = std::move(other);
}

UnfinishedFile& UnfinishedFile::operator=(UnfinishedFile&& other) noexcept {
  std::swap(target_, other.target_);
  std::swap(path_, other.path_);
  std::swap(lock_, other.lock_);
  std::swap(earlier_, other.earlier_);
  return *this;
}

UnfinishedFile::~UnfinishedFile() {
  if (exists()) {
    UnfinishedFiles& files = unfinished_files();
    const std::lock_guard guard(files.mutex);
    remove_whole(path_);
    files.paths.erase(path_);
  }
  if (lock_ >= 0) ::close(lock_);
}

UnfinishedFile::FileId UnfinishedFile::id_of(const std::string& path) {
  struct stat info {};
  if (::lstat(path.c_str(), &info) != 0) return {};
  return {info.st_dev, info.st_ino};
}

Result<UnfinishedFile> UnfinishedFile::begin(const std::string& target) {
  return begin(target, Kind::file);
}

Result<UnfinishedFile> UnfinishedFile::begin_folder(const std::string& target) {
  return begin(target, Kind::folder);
}

Result<UnfinishedFile> UnfinishedFile::begin(const std::string& target, Kind kind) {
  UnfinishedFiles& files = unfinished_files();
  const std::lock_guard guard(files.mutex);
  tidy_folder_of(target, files);
  const std::string path = target + kEnding;
  for (int tries = 0; tries < kTries; ++tries) {
    if (tries > 0) std::this_thread::sleep_for(kBetweenTries);
    const int descriptor = kind == Kind::file ? make_file(path) : make_folder(path);
    if (descriptor < 0 && errno != EEXIST) return cannot_write(target, errno);
    const bool is_ours = descriptor >= 0 && lock(descriptor, path);
    if (is_ours && !is_locked(target)) {
      files.paths.insert(path);
      return UnfinishedFile(target, descriptor);
    }
    if (is_ours) remove_whole(path);
    if (descriptor < 0) remove_left_over(path);
    if (descriptor >= 0) ::close(descriptor);
    if (is_ours) break;
  }
  return is_being_written(target);
}

bool UnfinishedFile::is_begun(const std::string& target) {
  UnfinishedFiles& files = unfinished_files();
  const std::lock_guard guard(files.mutex);
  return files.paths.contains(target + kEnding);
}

int UnfinishedFile::duplicate_descriptor() const {
  return ::fcntl(lock_, F_DUPFD_CLOEXEC, 0);
}

Result<Placed> UnfinishedFile::take_place() {
  UnfinishedFiles& files = unfinished_files();
  const std::lock_guard guard(files.mutex);
  Placed placed{target_, Done{}};
  const bool replaces = earlier_ != FileId{} && id_of(target_) == earlier_;
  int error = replaces ? rename_over(path_, target_) : rename_to_unused(path_, target_);
  while (error == EEXIST || error == ENOTEMPTY) {
    placed.path = unused_name(target_, time_stamp(std::chrono::system_clock::now()));
    placed.told =
        failed(in_quotes(target_) + " is another's by now, and stays; what was written is " + in_quotes(placed.path));
    error = rename_to_unused(path_, placed.path);
  }
  if (error != 0) return cannot_write(target_, error);
  files.paths.erase(path_);
  path_.clear();
  ::close(std::exchange(lock_, -1));
  return placed;
}

void remove_unfinished_files() {
  UnfinishedFiles& files = unfinished_files();
  files.mutex.lock();
  for (const std::string& path : files.paths) remove_whole(path);
}

Error cannot_write(const std::string& path, int error_number) {
  return failed("cannot write " + in_quotes(path) + ": " + std::strerror(error_number));
}

}  // namespace dermis::bytes::files
