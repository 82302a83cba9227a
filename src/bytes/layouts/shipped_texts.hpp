// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <string_view>
#include <vector>

namespace dermis::bytes::layouts {

/// Name and content of each file in the folder shipped, by name. Its source is made by CMake.
[[nodiscard]] const std::vector<std::array<std::string_view, 2>>& shipped_texts();

}  // namespace dermis::bytes::layouts
