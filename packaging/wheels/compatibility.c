// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// dermis and static libraries of Debian 12 ask for names of glibc 2.32 to 2.36. glibc 2.31 has them not.
#include <dirent.h>
#include <errno.h>
#include <spawn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/random.h>

#define HIDDEN __attribute__((visibility("hidden")))

/// Reference counts are always atomic.
HIDDEN char __libc_single_threaded = 0;

/// For Expat. getentropy() gives at most 256 bytes a call.
HIDDEN void arc4random_buf(void* bytes, size_t size) {
  for (size_t done = 0; done < size;) {
    const size_t piece = size - done < 256 ? size - done : 256;
    if (getentropy((char*)bytes + done, piece) != 0) abort();
    done += piece;
  }
}

/// For std::random_device.
HIDDEN uint32_t arc4random(void) {
  uint32_t bits;
  arc4random_buf(&bits, sizeof bits);
  return bits;
}

/// All files that are open now: one that another thread opens until the child is there is not closed.
HIDDEN int posix_spawn_file_actions_addclosefrom_np(posix_spawn_file_actions_t* actions, int from) {
  DIR* folder = opendir("/proc/self/fd");
  if (folder == NULL) return errno;
  int failure = 0;
  for (struct dirent* entry = readdir(folder); failure == 0 && entry != NULL; entry = readdir(folder)) {
    const int file = atoi(entry->d_name);
    if (file >= from && file != dirfd(folder)) failure = posix_spawn_file_actions_addclose(actions, file);
  }
  closedir(folder);
  return failure;
}

/// What archives of Debian use in place of the streams of glibc (make_archives of prefix).
HIDDEN FILE* dermis_stdin;
HIDDEN FILE* dermis_stdout;
HIDDEN FILE* dermis_stderr;

__attribute__((constructor)) static void take_streams(void) {
  dermis_stdin = stdin;
  dermis_stdout = stdout;
  dermis_stderr = stderr;
}
