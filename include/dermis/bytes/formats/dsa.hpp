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

/// Recordings of the Weiss DSA, the tactile sensors of a SCHUNK SDH hand (.dsa, .dsa3). They are XML, usually
/// compressed by bzip2, with the counts of all matrices in one run-length code a frame. options.array is the number of
/// the matrix, from 0, where there are several. If the file has the temperatures of the hand, a frame of matrix m has
/// the last one of its axis (1 + m). A last frame that is cut is left out, with a notice. The memory is that of a frame
/// and of the temperatures, at most 16 MiB. `in` must be able to seek; `name` stands for the path in messages.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_dsa(std::unique_ptr<std::istream> in, const std::string& name,
                                                            const ImportOptions& options);

}  // namespace dermis::bytes::formats
