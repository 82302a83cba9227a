// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "dermis/live/sources/source_name.hpp"
#include "out/serve/setup/first_look.hpp"

namespace dermis::out::serve {

/// /suit.json of an array that is not described yet. `name`: empty where clients have not chosen it; `layout`: that a
/// client has chosen, else empty.
[[nodiscard]] std::string setup_json(const std::optional<live::sources::SourceName>& name, const FirstLook& found,
                                     const std::string& layout);

/// Missing readings are null.
[[nodiscard]] nlohmann::ordered_json counts_json(const std::vector<float>& counts);

}  // namespace dermis::out::serve
