// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/system/thread_priority.hpp"

#include <sys/resource.h>
#include <unistd.h>

namespace dermis {

void raise_thread_priority() noexcept {
  static_cast<void>(::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), -10));
}

}  // namespace dermis
