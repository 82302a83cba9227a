// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>

namespace dermis::app {

/// A flag that SIGINT, SIGTERM and SIGHUP set from the first call on, so that live commands end with complete files. A
/// second signal ends the process at once.
[[nodiscard]] std::atomic<bool>& stop_flag();

}  // namespace dermis::app
