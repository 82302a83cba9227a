// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "dermis/core/frame_source.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"

namespace dermis::serve {

/// Writes frames.csv; `fill` makes each of the `count` frames.
[[nodiscard]] Status write_frames(const std::string& path, FrameShape shape, std::size_t count,
                                  const std::function<void(std::size_t number, RawFrame& frame)>& fill);

}  // namespace dermis::serve
