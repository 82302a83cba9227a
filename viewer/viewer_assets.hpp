// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

#include "dermis/out/websocket/server.hpp"

namespace dermis::viewer {

/// The files of the viewer, "/index.html" among them.
[[nodiscard]] std::span<const out::websocket::Asset> assets();

}  // namespace dermis::viewer
