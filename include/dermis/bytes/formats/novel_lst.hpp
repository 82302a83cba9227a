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

/// Listings of novel (emed, pliance: .lst): pages with "Pict-No.: 7" and a table of kilopascals. The first line has the
/// numbers of the columns and the first column those of the rows, both counted from 1 on the whole platform. Pages of
/// the same picture are one frame. MPP and MVP, the sums of a measurement, are skipped, and so are sums of force. Cells
/// that a table does not have are 0. Where options.shape is given, a table lies at its place on the platform; else the
/// frames are the smallest rectangle that holds all tables. A last frame that is cut is left out, with a notice. The
/// memory is that of a frame and of a line, at most 32 MiB. `in` must be able to seek; `name` stands for the path in
/// messages.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_novel_lst(std::unique_ptr<std::istream> in,
                                                                  const std::string& name,
                                                                  const ImportOptions& options);

}  // namespace dermis::bytes::formats
