// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

namespace dermis::benchmarks {

/// Prints what each published method leaves of the crosstalk of the same random arrays, and its time.
void print_methods(std::size_t arrays);

}  // namespace dermis::benchmarks
