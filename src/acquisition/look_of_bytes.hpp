// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace dermis::acquisition {

/// Describes bytes of which no protocol makes frames, as a sentence without its full stop.
[[nodiscard]] std::string look_of_bytes(std::span<const std::uint8_t> bytes);

}  // namespace dermis::acquisition
