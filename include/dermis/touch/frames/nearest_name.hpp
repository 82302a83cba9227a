// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <set>
#include <string>

namespace dermis {

/// The known name nearest to `name` by inserted, removed or replaced characters, for "did you mean ...?"; empty if none
/// is near enough.
[[nodiscard]] std::string nearest_name(const std::string& name, const std::set<std::string>& known);

}  // namespace dermis
