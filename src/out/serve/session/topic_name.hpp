// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

namespace dermis::out::serve {

/// A name that topics may have, as suit.toml asks for.
[[nodiscard]] std::string topic_name(const std::string& name);

}  // namespace dermis::out::serve
