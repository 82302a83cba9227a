// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dermis::app {

/// Prints how often each class was answered with each, [classes, classes]; nothing of more classes than can be read.
void print_confusion(const std::vector<std::string>& names, const std::vector<std::size_t>& confusion);

}  // namespace dermis::app
