// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "bytes/proposals/draft.hpp"
#include "dermis/bytes/proposals/proposals.hpp"

namespace dermis::bytes::proposals {

/// Layouts that lines of text may have.
[[nodiscard]] std::vector<Draft> text_drafts(std::string_view text, const Known& known);

}  // namespace dermis::bytes::proposals
