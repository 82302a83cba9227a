// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/out/serve/served_suit.hpp"
#include "out/serve/suit/models_in_use.hpp"

namespace dermis::out::serve {

/// /suit.json of docs/stream.md.
[[nodiscard]] std::string suit_json(const ServedSuit& suit, const ModelsInUse& models);

}  // namespace dermis::out::serve
