// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::app {

/// How commands open what --from, --in and --frames name: live sources end where stop_flag() is set, and what a user
/// should know goes to stderr.
[[nodiscard]] live::sources::SourceOptions source_options(const ArrayDescription* array = nullptr);

}  // namespace dermis::app
