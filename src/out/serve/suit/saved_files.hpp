// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// Writes frames.csv; `fill` makes each of the `count` frames.
[[nodiscard]] Status write_frames(const std::string& path, FrameShape shape, std::size_t count,
                                  const std::function<void(std::size_t number, RawFrame& frame)>& fill);

}  // namespace dermis::out::serve
