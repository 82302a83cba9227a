// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>

namespace dermis::out::datasets {

/// Calls body(0) ... body(count - 1) on all cores, in any order. Bodies must not share what they write.
void in_parallel(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace dermis::out::datasets
