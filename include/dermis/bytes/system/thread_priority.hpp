// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis {

/// The calling thread, and those that it starts from now on, go before the rest of the process and other programs
/// (nice -10). Who acquires frames and who writes them have the same share, so neither starves the other. Nothing
/// changes where the system does not allow it.
void raise_thread_priority() noexcept;

}  // namespace dermis
