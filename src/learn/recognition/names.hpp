// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::recognition {

/// UTF-8 without control characters: files of classes and lines of answers hold it as it is.
[[nodiscard]] bool is_plain_text(const std::string& text);

/// Fails on what is no plain text, and on "unknown", which is the answer for what is like no class.
[[nodiscard]] Status check_class_name(const std::string& name);

}  // namespace dermis::learn::recognition
