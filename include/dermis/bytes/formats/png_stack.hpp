// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/formats/import_options.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::formats {

/// A picture whose grey levels are readings: [shape.rows, shape.cols], the first row at the top.
struct GreyPicture {
  FrameShape shape;
  std::vector<std::uint16_t> levels;  ///< Values as in the file: 0 ... 255, with 16 bits 0 ... 65535.
};

/// Reads a PNG of grey levels, of 1 to 16 bits; transparency is left out. Fails on colours, and on more than 1024 rows
/// or columns. `name` stands for the path in messages. Thread-safe.
[[nodiscard]] Result<GreyPicture> read_grey_png(std::string_view bytes, const std::string& name);

/// A folder of such pictures, one a frame, in the order of the numbers in their names (frame2.png before frame10.png),
/// or a single one. There are no times: options.rate_hz gives them. The memory is that of a frame, of a file, at most
/// 16 MiB, and of the names.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_png_stack(const std::string& path,
                                                                  const ImportOptions& options);

}  // namespace dermis::bytes::formats
