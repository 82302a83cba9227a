// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Functions of POSIX that WASI does not know. The page gives those of descriptors (viewer/src/try/system.ts).
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>

#define DERMIS_IMPORT(name) __attribute__((import_module("dermis"), import_name(#name)))

extern "C" {

DERMIS_IMPORT(duplicate) int dermis_duplicate(int descriptor);
DERMIS_IMPORT(lock) int dermis_lock(int descriptor, int how);

int dup(int descriptor) {
  const int made = dermis_duplicate(descriptor);
  if (made >= 0) return made;
  errno = -made;
  return -1;
}

int flock(int descriptor, int how) {
  errno = dermis_lock(descriptor, how);
  return errno == 0 ? 0 : -1;
}

int __real_fcntl(int descriptor, int command, ...);
/// In the place of that of WASI, which does not know F_DUPFD_CLOEXEC (--wrap of the linker).
int __wrap_fcntl(int descriptor, int command, ...) {
  if (command == F_DUPFD_CLOEXEC) return dup(descriptor);
  va_list list;
  va_start(list, command);
  const int flags = va_arg(list, int);
  va_end(list);
  return __real_fcntl(descriptor, command, flags);
}

uid_t geteuid() {
  return 0;
}

/// Who asks renames by himself then.
int renameat2(int /*from_folder*/, const char* /*from*/, int /*to_folder*/, const char* /*to*/, unsigned /*flags*/) {
  errno = ENOSYS;
  return -1;
}

}  // extern "C"
