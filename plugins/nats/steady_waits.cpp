// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <nats/nats.h>
#include <pthread.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <ctime>

// The library of NATS (3.4) waits by the UTC clock. If that is set back by an hour while the library waits to connect
// again, it waits for an hour. These functions take the place of its own ones, as its symbols are looked for in this
// plugin first. So all its waits are by the steady clock.

namespace {

constexpr std::int64_t kMsPerSecond = 1000;
constexpr std::int64_t kNanosPerMs = 1'000'000;

}  // namespace

#define DERMIS_TAKES_PLACE extern "C" __attribute__((visibility("default")))

// NOLINTBEGIN(readability-identifier-naming): of the library
DERMIS_TAKES_PLACE std::int64_t nats_NowInNanoSeconds() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

DERMIS_TAKES_PLACE std::int64_t nats_Now() {
  return nats_NowInNanoSeconds() / kNanosPerMs;
}

/// `end_ms`: by nats_Now().
DERMIS_TAKES_PLACE natsStatus natsCondition_AbsoluteTimedWait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                                                              std::int64_t end_ms) {
  if (end_ms <= 0) return NATS_TIMEOUT;
  const timespec end{static_cast<std::time_t>(end_ms / kMsPerSecond), end_ms % kMsPerSecond * kNanosPerMs};
  const int outcome = ::pthread_cond_clockwait(condition, mutex, CLOCK_MONOTONIC, &end);
  if (outcome == ETIMEDOUT) return NATS_TIMEOUT;
  return outcome == 0 ? NATS_OK : NATS_SYS_ERROR;
}

DERMIS_TAKES_PLACE natsStatus natsCondition_TimedWait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                                                      std::int64_t ms) {
  if (ms <= 0) return NATS_TIMEOUT;
  return natsCondition_AbsoluteTimedWait(condition, mutex, nats_Now() + ms);
}
// NOLINTEND(readability-identifier-naming)
