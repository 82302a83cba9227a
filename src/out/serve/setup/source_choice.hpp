// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>

#include "dermis/live/sources/source_name.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// Where the array of a client may be, as JSON: {"ports": [{"device", "path", "product"}], "recordings": [name],
/// "simulations": [scene]}. Opens none.
[[nodiscard]] std::string source_choices();

/// The choice of a client: {"port": path of one of the ports, "baud": 115200}, {"recording": one of them},
/// {"simulation": one of them}, or {"address": "192.168.4.1:3333"}. An address may also be a URI of TCP or UDP. Fails
/// on anything that source_choices() does not offer.
[[nodiscard]] Result<live::sources::SourceName> source_request(std::string_view text);

}  // namespace dermis::out::serve
