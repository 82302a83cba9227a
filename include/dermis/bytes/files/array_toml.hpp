// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// Reads array.toml (docs/array-toml.md). The result has passed ArrayDescription::validate().
[[nodiscard]] Result<ArrayDescription> read_array(const std::string& path);
/// The same from memory; `name` stands for the path in messages.
[[nodiscard]] Result<ArrayDescription> array_from_toml(std::string_view text, const std::string& name);

/// Writes a valid array as array.toml.
[[nodiscard]] Status write_array(const std::string& path, const ArrayDescription& array);
/// The text of that file. Reads back as the same array, lengths and areas up to rounding.
[[nodiscard]] std::string array_to_toml(const ArrayDescription& array);

}  // namespace dermis::bytes::files
