// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/out/serve/served_suit.hpp"

namespace dermis::out::serve {

/// The arrays of the suit take their frames from a recording. Fails where one is not in it, or is another there.
[[nodiscard]] Status open_playback(const std::string& from, ServedSuit& suit);

}  // namespace dermis::out::serve
