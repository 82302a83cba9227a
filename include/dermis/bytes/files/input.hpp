// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <string>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// A path that cannot be opened is bad input; a later error is a failure.
[[nodiscard]] Result<std::unique_ptr<std::istream>> open_input(const std::string& path);

/// Call it right after a stream went bad.
[[nodiscard]] Error read_failure(const std::string& name);

/// The first bytes of a regular file, at most max_bytes; none where it cannot be read.
[[nodiscard]] std::string first_bytes_of(const std::string& path, std::size_t max_bytes);

/// All bytes of a file, at most max_bytes.
[[nodiscard]] Result<std::string> read_file(const std::string& path, std::size_t max_bytes);

}  // namespace dermis::bytes::files
