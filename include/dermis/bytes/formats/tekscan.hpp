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

/// ASCII exports of Tekscan (I-Scan, F-Scan, Conformat: .asf, .csv, .txt). They hold keys such as ROWS, COLS,
/// SECONDS_PER_FRAME and UNITS, and a line ASCII_DATA @@. Then come "Frame 1" and a line of numbers a row. Pressures of
/// any unit come as kilopascals, forces as newtons, UNITS RAW as it is; "B", a cell outside the sensor, as NaN. A last
/// frame that is cut is left out, with a notice. The memory is that of a frame and of a line, at most 32 MiB. `name`
/// stands for the path in messages.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_tekscan(std::unique_ptr<std::istream> in,
                                                                const std::string& name, const ImportOptions& options);

}  // namespace dermis::bytes::formats
