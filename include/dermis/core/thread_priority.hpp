// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis {

/// Which threads go first where the machine has not enough time for all.
enum class ThreadPriority {
  high,  ///< No frame may be lost for want of them. Needs a right to nice -10; without it, nothing changes.
  low,   ///< May be late: nice 5.
};

/// Of the calling thread, and of the threads that it starts from now on.
void set_thread_priority(ThreadPriority priority) noexcept;

}  // namespace dermis
