// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace dermis::bytes::ros_messages {

/// counts -> the bytes of uint16, little-endian. Returns false, with any values, where not all counts are whole numbers
/// of 0 ... 65535 (-0 is none). `out` is not aligned and does not overlap. SIMD (Highway, run-time dispatch).
[[nodiscard]] bool counts_to_uint16(const float* counts, std::size_t count, std::uint8_t* out) noexcept;

/// The bytes of uint16, little-endian -> counts.
void uint16_to_counts(const std::uint8_t* bytes, std::size_t count, float* counts) noexcept;

}  // namespace dermis::bytes::ros_messages
