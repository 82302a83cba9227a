// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/core/result.hpp"

namespace dermis::files {

/// "fnv1a64:" and 16 hexadecimal digits: the FNV-1a hash of the bytes of a file. It detects accidental changes, not
/// forgery.
[[nodiscard]] Result<std::string> content_hash(const std::string& path);

}  // namespace dermis::files
