// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Static libraries of Debian 12 ask for names of glibc 2.32 to 2.36. glibc 2.31 has them not.
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

/// What archives of Debian use in place of the streams of glibc (make_archives of prefix).
HIDDEN FILE* dermis_stdin;
HIDDEN FILE* dermis_stdout;
HIDDEN FILE* dermis_stderr;

__attribute__((constructor)) static void take_streams(void) {
  dermis_stdin = stdin;
  dermis_stdout = stdout;
  dermis_stderr = stderr;
}
