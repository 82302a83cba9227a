// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// The text of a configuration; of a file that is too large, more than check_config_text() lets pass.
[[nodiscard]] Result<std::string> read_config_text(const std::string& path);

/// Bounds that the TOML parser itself does not check: 1 MiB, and the parts of a dotted key. `name` stands for the path.
[[nodiscard]] Status check_config_text(std::string_view text, const std::string& name);

/// "\xHH" of TOML 1.1 in texts becomes "\u00HH", as TOML 1.0 has it.
[[nodiscard]] std::string with_byte_escapes(std::string_view text);

}  // namespace dermis::bytes::files
