// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

namespace dermis::learn::calibration {

/// Separate stressed areas (8-connected) of a frame; taxels of unknown share (NaN) count as stressed.
[[nodiscard]] std::size_t count_contacts(const std::vector<float>& known_newtons, std::size_t rows, std::size_t cols);

}  // namespace dermis::learn::calibration
