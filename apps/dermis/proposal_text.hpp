// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/describing/proposals.hpp"

namespace dermis::app {

/// A proposal for a person, in lines; `place` counts from 1.
[[nodiscard]] std::string proposal_text(const describing::Proposal& proposal, std::size_t place);

}  // namespace dermis::app
