// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"

namespace dermis::learn::calibration {

/// touch::fusion::ForceNetworks::end_bends, as the samples of single taxels next to the lightest and to the heaviest
/// loads show them. 0 where they do not tell.
[[nodiscard]] std::array<float, 2> find_end_bends(const SampleDatabase& database,
                                                  touch::fusion::ForceNetworks networks);

}  // namespace dermis::learn::calibration
