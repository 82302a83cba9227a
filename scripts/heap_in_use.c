// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// How much of its heap a process has in use, for scripts/week and LD_PRELOAD: once a second, bytes as int64 in the file
// that HEAP_IN_USE names. Holes between, which the C library keeps, do not count.
#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

static void* look(void* place) {
  while (1) {
    const struct mallinfo2 heap = mallinfo2();
    *(_Atomic int64_t*)place = (int64_t)(heap.uordblks + heap.hblkhd);
    sleep(1);
  }
  return NULL;
}

__attribute__((constructor)) static void begin(void) {
  const char* const path = getenv("HEAP_IN_USE");
  const int file = path ? open(path, O_RDWR | O_CLOEXEC) : -1;
  if (file < 0) return;
  void* const place = mmap(NULL, sizeof(int64_t), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  pthread_t thread;
  if (place != MAP_FAILED) pthread_create(&thread, NULL, look, place);
}
