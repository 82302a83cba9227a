// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "support/disk_calls.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdio>
#include <mutex>
#include <utility>

namespace {

std::mutex calls_mutex;
std::vector<std::string> calls;

void note(const char* call) {
  const std::scoped_lock lock(calls_mutex);
  calls.emplace_back(call);
}

const char* what_is_synchronised(int descriptor) {
  struct stat info {};
  return ::fstat(descriptor, &info) == 0 && S_ISDIR(info.st_mode) ? "names" : "bytes";
}

}  // namespace

// Those of the C library, for this program.
extern "C" {

int fsync(int descriptor) {
  note(what_is_synchronised(descriptor));
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

int fdatasync(int descriptor) {
  note(what_is_synchronised(descriptor));
  return static_cast<int>(::syscall(SYS_fdatasync, descriptor));
}

int rename(const char* from, const char* to) noexcept {
  note("rename");
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  note("rename");
  return static_cast<int>(::syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}

}  // extern "C"

namespace dermis::support {

std::vector<std::string> take_disk_calls() {
  const std::scoped_lock lock(calls_mutex);
  return std::exchange(calls, {});
}

}  // namespace dermis::support
