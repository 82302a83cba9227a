// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "out/serve/suit/models_in_use.hpp"

namespace dermis::out::serve {

/// How the arrays are recorded now.
[[nodiscard]] std::vector<bytes::recordings::RecordedArray> recorded_arrays(const ServedSuit& suit,
                                                                            const ModelsInUse& models);

}  // namespace dermis::out::serve
