// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis {

/// People read and write millimetres; everything else is in metres.
inline constexpr double kMillimetresPerMetre = 1e3;

}  // namespace dermis
