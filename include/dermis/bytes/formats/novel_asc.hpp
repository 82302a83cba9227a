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

/// Exports of novel (pedar, pliance: .asc). After a head comes the line "time[secs]", 1, 2, 3 and so on, then a line of
/// kilopascals a frame. The file does not tell where a sensor is: frames have one row, or the shape of options.shape,
/// row by row. A last frame that is cut is left out, with a notice. The memory is that of a frame and of a line, at
/// most 32 MiB. `name` stands for the path in messages.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_novel_asc(std::unique_ptr<std::istream> in,
                                                                  const std::string& name,
                                                                  const ImportOptions& options);

}  // namespace dermis::bytes::formats
