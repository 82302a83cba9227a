// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis {

/// The calling thread, and those that it starts from now on, go before the threads of other programs: frames wait for
/// it. Needs a right to nice -10; without it, nothing changes.
void raise_thread_priority() noexcept;

}  // namespace dermis
