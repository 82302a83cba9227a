// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "bytes/proposals/smoothness.hpp"

namespace dermis::bytes::proposals {

/// What a layout makes of the bytes.
struct Trial {
  std::size_t frames = 0;        ///< Of the array that has the fewest.
  std::uint64_t left = 0;        ///< Bytes that belong to no frame.
  std::uint64_t lost = 0;        ///< Gaps in the frame numbers.
  Readings readings;             ///< The first frames of the first array.
  bool has_empty_array = false;  ///< Whose readings are all 0.
};

/// Decodes the bytes; empty where the layout is none.
[[nodiscard]] std::optional<Trial> try_layout(const std::string& toml, std::span<const std::uint8_t> bytes);

}  // namespace dermis::bytes::proposals
