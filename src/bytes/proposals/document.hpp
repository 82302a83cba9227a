// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bytes/proposals/lines.hpp"

namespace dermis::bytes::proposals {

/// A list or an object of JSON that goes over all lines, or is the only one.
[[nodiscard]] bool is_document(std::string_view text);

/// With blanks in the place of CR and LF.
[[nodiscard]] std::string without_breaks(std::string_view text);

/// The innermost objects or lists of a document without breaks. `text` must outlive them.
[[nodiscard]] std::vector<Line> pieces_of_document(std::string_view text, char opening, char closing);

}  // namespace dermis::bytes::proposals
