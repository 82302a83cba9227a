// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/learn/recognition/segment.hpp"
#include "learn/recognition/features/feature_columns.hpp"

namespace dermis::learn::recognition {

/// The features by what they say in plain words, "place", "force" ...; aspects without a feature are left out.
[[nodiscard]] std::vector<ExpertColumns> aspect_columns(const Layout& layout, bool moving);

}  // namespace dermis::learn::recognition
