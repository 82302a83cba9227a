// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

namespace dermis {

/// The text with '?' in place of characters that control terminals, newlines included: those of ASCII, and U+0080 to
/// U+009F in UTF-8.
[[nodiscard]] std::string one_line(std::string text);

}  // namespace dermis
