// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <istream>
#include <memory>
#include <string>

#include "dermis/bytes/formats/import_options.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::formats {

/// ASCII exports of XSENSOR (.csv), with or without quotes. Each FRAME has its Date and Time. Each SENSOR has its Rows,
/// Columns and the pressures below SENSELS. Pressures of any unit come as kilopascals, an empty cell as NaN.
/// options.array names one of several sensors. Times count from 1970 where there is a date, by the clock of the wall
/// where it was recorded. Groups of sensels are passed over. A last frame that is cut is left out, with a notice. The
/// memory is that of a frame and of a line, at most 32 MiB. `in` must be able to seek; `name` stands for the path in
/// messages.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_xsensor(std::unique_ptr<std::istream> in,
                                                                const std::string& name, const ImportOptions& options);

}  // namespace dermis::bytes::formats
