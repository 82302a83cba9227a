// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "bytes/devices/protocols.hpp"

namespace dermis::bytes::devices {

/// Protocols that layouts describe: a file of layouts/shipped each.
[[nodiscard]] const std::vector<ProtocolEntry>& described_protocols();

}  // namespace dermis::bytes::devices
