// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace dermis::bytes::proposals {

/// Escapes of packets in which codes may stand for bytes, as in a layout: "5D 5C 00=5C 01=5B 02=5D". The bytes that the
/// codes stand for are those that fit the packets beside them best.
[[nodiscard]] std::vector<std::string> substitutions_in(std::span<const std::uint8_t> bytes);

}  // namespace dermis::bytes::proposals
