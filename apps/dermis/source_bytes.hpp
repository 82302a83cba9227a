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
  std::string known{};  ///< What dermis reads them as already: the name of a protocol or of a format; empty: nothing.
  bool is_stream = false;  ///< Of a device, or kept as a device sends them.
  std::string start{};     ///< Bytes that the device was sent before it began,
  std::string request{};   ///< or before each of its answers.
};

/// Of a device what comes within 3 s, at most 64 KiB; of a file the beginning. Fails where nothing comes. `asks`: as of
/// ask_device(); empty: the device is not asked.
[[nodiscard]] Result<SourceBytes> read_source_bytes(const std::string& source, const std::string& asks);

}  // namespace dermis::app
