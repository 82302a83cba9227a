// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>

namespace dermis::bytes::proposals {

/// What ends the lines of a text, as in a layout: empty for LF and CR LF.
[[nodiscard]] std::string line_end_of(std::string_view text);

}  // namespace dermis::bytes::proposals
