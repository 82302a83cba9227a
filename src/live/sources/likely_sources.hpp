// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/live/sources/array_folder.hpp"

namespace dermis::live::sources {

/// Where the device of the folder may be, the likeliest first: its place of last time and, at a serial port, the
/// others.
[[nodiscard]] std::vector<SourceName> likely_sources(const ArrayFolder& folder);

}  // namespace dermis::live::sources
