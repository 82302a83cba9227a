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

/// Arrays of NumPy in a zip archive (numpy.savez, numpy.savez_compressed). If there are several, options.array names
/// the one with the frames. It is read as a .npy file (files/npy.hpp), with the times of options.rate_hz. The memory is
/// that of a frame and of the archive's list of contents, at most 16 MiB. `in` must be able to seek; `name` stands for
/// the path in messages.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_npz(std::unique_ptr<std::istream> in, const std::string& name,
                                                            const ImportOptions& options);

}  // namespace dermis::bytes::formats
