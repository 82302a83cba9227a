// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace dermis::bytes::proposals {

/// Nearly all bytes are letters, digits, signs and ends of lines.
[[nodiscard]] bool is_text(std::span<const std::uint8_t> bytes);

/// For a message: what is no letter, digit or sign becomes '?'.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace dermis::bytes::proposals
