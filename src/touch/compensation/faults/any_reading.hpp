// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

namespace dermis::touch::compensation {

/// Some reading is not below `least`. The look at the whole frame takes less than a branch at each reading.
[[nodiscard]] bool any_is_above(std::span<const double> ratio, double least) noexcept;

}  // namespace dermis::touch::compensation
