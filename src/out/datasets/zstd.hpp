// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace dermis::out::datasets {

/// The fastest level that ordinary readers take.
inline constexpr int kZstdLevel = 1;

/// One frame of zstd, which says how many bytes it holds. Thread-safe.
[[nodiscard]] std::string zstd_compressed(std::span<const std::byte> bytes);

}  // namespace dermis::out::datasets
