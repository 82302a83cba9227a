// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::layouts {

/// The fields of "{row},{values}". Errors are those of the pattern.
[[nodiscard]] Result<TextLayout::Pattern> parse_line_pattern(std::string_view pattern,
                                                             const std::vector<LayoutArray>& arrays);

}  // namespace dermis::bytes::layouts
