// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/devices/byte_stream.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// In the place of a text, the bytes that boards usually wait for.
inline constexpr std::string_view kUsualAsks = "usual";

/// How a device was made to send.
struct Asked {
  std::vector<std::uint8_t> bytes{};  ///< Its answers.
  std::string start{};                ///< The bytes after which it goes on by itself,
  std::string request{};              ///< or those that each answer needs; both empty: it sends on its own.
};

/// Sends an open stream one thing after the other until it answers. `asks`: kUsualAsks, or a text with the escapes of
/// TOML. Takes up to 20 s. Fails where nothing is answered.
[[nodiscard]] Result<Asked> ask_device(bytes::devices::ByteStream& stream, const std::string& asks);

}  // namespace dermis::app
