// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis {

/// Threads that go before the rest of the process and other programs.
enum class ThreadPriority {
  frames,     ///< Acquires frames: nice -10.
  recording,  ///< Writes them: nice -5, so that it has its share however busy the first are.
};

/// Of the calling thread, and of those that it starts from now on. Nothing changes where the system does not allow it.
void raise_thread_priority(ThreadPriority priority) noexcept;

}  // namespace dermis
