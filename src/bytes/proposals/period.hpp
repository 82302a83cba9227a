// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>

namespace dermis::bytes::proposals {

/// After how many numbers, `least` or more, they come again nearly as they were; 0 where nothing shows it.
[[nodiscard]] std::size_t period_of(std::span<const float> numbers, std::size_t least);

}  // namespace dermis::bytes::proposals
