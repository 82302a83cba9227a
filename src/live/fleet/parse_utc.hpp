// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::live::fleet {

/// Since 1970, of "2026-11-28T05:00:00Z", also with a fraction of a second; empty of any other text.
[[nodiscard]] std::optional<Nanos> parse_utc(const std::string& text);

}  // namespace dermis::live::fleet
