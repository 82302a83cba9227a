// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// The first bytes of a source, as they come.
struct SourceBytes {
  std::vector<std::uint8_t> bytes;
  std::string known{};     ///< The protocol or format that dermis reads them as; empty: none.
  bool is_stream = false;  ///< They come from a device, or are kept as a device sends them.
  std::string start{};     ///< Bytes that the device was sent before it began,
  std::string request{};   ///< or before each of its answers.
};

/// Of a device what comes within 3 s, at most 64 KiB; of a file the beginning. Fails where nothing comes. `asks`: as of
/// ask_device(); empty: the device is not asked.
[[nodiscard]] Result<SourceBytes> read_source_bytes(const std::string& source, const std::string& asks);

}  // namespace dermis::app
