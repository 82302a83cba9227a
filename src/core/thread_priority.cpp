// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/core/thread_priority.hpp"

#include <sys/resource.h>
#include <unistd.h>

namespace dermis {
namespace {

constexpr int kHigh = -10;
constexpr int kLow = 5;

}  // namespace

void set_thread_priority(ThreadPriority priority) noexcept {
  const int nice = priority == ThreadPriority::high ? kHigh : kLow;
  static_cast<void>(::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), nice));
}

}  // namespace dermis
