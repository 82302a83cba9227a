// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <string>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// "20261122-101500", in UTC: a part of file names.
[[nodiscard]] std::string time_stamp(std::chrono::system_clock::time_point time);

/// "chest-SUFFIX.toml" for "chest.toml", with "-2" and so on where that name is taken.
[[nodiscard]] std::string unused_name(const std::string& path, const std::string& suffix);

/// Copies a file that is to be replaced at `time`, byte by byte, and returns the path of the copy. For "chest.toml" it
/// is "chest-before-20261122-101500.toml" beside it, or the next unused_name(). It never overwrites.
[[nodiscard]] Result<std::string> keep_copy(const std::string& path, std::chrono::system_clock::time_point time);

}  // namespace dermis::bytes::files
