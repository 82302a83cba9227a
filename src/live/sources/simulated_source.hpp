// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>

#include "dermis/bytes/devices/source_uri.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::sources {

/// The source of a URI sim:SCENE, as open_source() describes it.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_simulation(const bytes::devices::SourceUri& uri,
                                                                   const SourceOptions& options);

}  // namespace dermis::live::sources
