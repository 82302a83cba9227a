// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis {

/// What people read and write is in millimetres, everything else in metres.
inline constexpr double kMillimetresPerMetre = 1e3;

}  // namespace dermis
