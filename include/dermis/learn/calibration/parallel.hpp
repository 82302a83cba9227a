// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>

namespace dermis::learn::calibration {

/// Calls body(0) ... body(count - 1) on all cores that this thread may run on, in any order; returns when all are done.
/// Bodies must not share what they write: results then do not depend on the number of threads. An exception
/// of a body reaches the caller, and no further body is begun. A body may call it, too: loops share the cores.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace dermis::learn::calibration
