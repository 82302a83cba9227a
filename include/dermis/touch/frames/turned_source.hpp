// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/line_order.hpp"

namespace dermis {

/// The frames of `source`, turned to the array's way round. A plain order gives the source itself. next() fails where
/// the order does not fit the frames; the error begins with `name`.
[[nodiscard]] std::unique_ptr<FrameSource> turned_source(std::unique_ptr<FrameSource> source, const LineOrder& order,
                                                         const std::string& name);

}  // namespace dermis
