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

/// Frames as blocks of lines with numbers: a line a row, with commas, semicolons, tabs or blanks between the values. An
/// empty value is a missing reading (NaN). Blocks end at a line without numbers (blank, "# frame 7", a header). If the
/// shape is given, they also end after its rows; otherwise the first block gives the shape. There are no times:
/// options.rate_hz gives them. A last block that is cut is left out, with a notice. The memory is that of two frames
/// and of a line, at most 32 MiB. `name` stands for the path in messages.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_text_matrix(std::unique_ptr<std::istream> in,
                                                                    const std::string& name,
                                                                    const ImportOptions& options);

}  // namespace dermis::bytes::formats
