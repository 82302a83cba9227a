// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::bytes {

/// A layout of lines or packets as docs/layouts.md allows, as TOML. Not every one is valid.
[[nodiscard]] std::string random_layout(Random& random);

/// Bytes that make the work of a decoder of that layout hard: marks, digits and separators that repeat, with damage.
[[nodiscard]] std::vector<std::uint8_t> hard_bytes(const layouts::Layout& layout, std::size_t size, Random& random);

}  // namespace dermis::bytes
