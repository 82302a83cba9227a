// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/bytes/proposals/proposals.hpp"

namespace dermis::app {

/// A proposal for a person, in lines; `place` counts from 1.
[[nodiscard]] std::string proposal_text(const bytes::proposals::Proposal& proposal, std::size_t place);

}  // namespace dermis::app
