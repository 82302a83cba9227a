// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/recordings/suit_recording.hpp"
#include "dermis/serve/served_suit.hpp"
#include "serve/suit/models_in_use.hpp"

namespace dermis::serve {

/// How the arrays are recorded now.
[[nodiscard]] std::vector<recordings::RecordedArray> recorded_arrays(const ServedSuit& suit, const ModelsInUse& models);

}  // namespace dermis::serve
