// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dermis/bytes/proposals/proposals.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/requests/json_request.hpp"

namespace dermis::out::serve {

/// Two digits a byte.
[[nodiscard]] std::string hex_of(std::span<const std::uint8_t> bytes);

/// {"rows": 8, "cols": 8}: what a client knows; either may be missing.
[[nodiscard]] Result<bytes::proposals::Known> known_request(const JsonRequest& request);

/// Layouts of the bytes, for a client: {"bytes": hexadecimal, "proposals": [{"summary", "layout", "reasons",
/// "doubts", "left_over", "open", "rows", "cols", "frames", "example", "parts": [[begin, end, "values"], ...]}, ...]}.
/// The bytes are the first 1024, and parts are of these.
[[nodiscard]] std::string layout_proposals(std::span<const std::uint8_t> bytes, const bytes::proposals::Known& known);

/// The layout that a client chooses, as TOML: {"layout": [line, ...]}, or {"place": 0} among layout_proposals() of
/// `bytes`, and what it knows.
[[nodiscard]] Result<std::string> wanted_layout(const JsonRequest& request, std::span<const std::uint8_t> bytes);

/// Writes a layout as `file`, where no other one may be. Returns the name of its first array; empty where it has but
/// one.
[[nodiscard]] Result<std::string> write_layout(const std::string& toml, const std::string& file);

/// The URI of a source, to be read by a layout. `array`: as of write_layout().
[[nodiscard]] std::string read_by_layout(const std::string& from, const std::string& file, const std::string& array);

}  // namespace dermis::out::serve
