// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>

#include "dermis/acquisition/source_uri.hpp"
#include "dermis/core/frame_source.hpp"
#include "dermis/core/result.hpp"
#include "dermis/sources/open_source.hpp"

namespace dermis::sources {

/// The source of a URI sim:SCENE, as open_source() describes it.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_simulation(const acquisition::SourceUri& uri,
                                                                   const SourceOptions& options);

}  // namespace dermis::sources
