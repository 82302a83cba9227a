// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// A UTC clock that scripts/week sets while a process runs: for LD_PRELOAD. The steady clock stays. The file that
// STEPPING_CLOCK names holds nanoseconds, int64, that are added to the time of the machine.
//
// As in the kernel, who waits until a time by the UTC clock waits longer where the clock is set back.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { kSecond = 1000000000, kLookEvery = 20000000 };

static const _Atomic int64_t* offset;

__attribute__((constructor)) static void open_offset(void) {
  const char* const path = getenv("STEPPING_CLOCK");
  const int file = path ? open(path, O_RDONLY | O_CLOEXEC) : -1;
  if (file < 0) return;
  void* const place = mmap(NULL, sizeof *offset, PROT_READ, MAP_SHARED, file, 0);
  if (place != MAP_FAILED) offset = place;
  close(file);
}

static struct timespec moved(struct timespec time, int64_t by) {
  const int64_t sum = time.tv_nsec + by % kSecond;
  const int64_t carry = (sum >= kSecond) - (sum < 0);
  time.tv_sec += by / kSecond + carry;
  time.tv_nsec = sum - carry * kSecond;
  return time;
}

int clock_gettime(clockid_t clock, struct timespec* time) {
  const int status = (int)syscall(SYS_clock_gettime, clock, time);
  const int is_utc = clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE;
  if (status == 0 && is_utc && offset) *time = moved(*time, *offset);
  return status;
}

int gettimeofday(struct timeval* restrict time, void* restrict zone) {
  (void)zone;
  struct timespec now;
  const int status = clock_gettime(CLOCK_REALTIME, &now);
  time->tv_sec = now.tv_sec;
  time->tv_usec = now.tv_nsec / 1000;
  return status;
}

time_t time(time_t* place) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (place) *place = now.tv_sec;
  return now.tv_sec;
}

typedef int Wait(pthread_cond_t*, pthread_mutex_t*, const struct timespec*);

/// Looks at the clock again and again, as it may have been set.
int pthread_cond_timedwait(pthread_cond_t* restrict condition, pthread_mutex_t* restrict mutex,
                           const struct timespec* restrict until) {
  static _Atomic(Wait*) wait;
  if (!wait) wait = (Wait*)dlvsym(RTLD_NEXT, "pthread_cond_timedwait", "GLIBC_2.3.2");
  while (1) {
    struct timespec machine;
    syscall(SYS_clock_gettime, CLOCK_REALTIME, &machine);
    const struct timespec now = moved(machine, offset ? *offset : 0);
    const double left = (double)(until->tv_sec - now.tv_sec) * kSecond + (double)(until->tv_nsec - now.tv_nsec);
    const struct timespec look = moved(machine, left < 0 ? 0 : left < kLookEvery ? (int64_t)left : kLookEvery);
    const int status = wait(condition, mutex, &look);
    if (status != ETIMEDOUT || left <= 0) return status;
  }
}
