// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

#include "dermis/stream/server.hpp"

namespace dermis::viewer {

/// The files of the viewer, "/index.html" among them.
[[nodiscard]] std::span<const stream::Asset> assets();

}  // namespace dermis::viewer
