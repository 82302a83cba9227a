// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/bytes/formats/import_options.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::recordings {

/// The file is one of MATLAB 7.3, which is HDF5.
[[nodiscard]] bool is_matlab_hdf5(const std::string& path);

/// Its frames, found as formats::open_matlab() does.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_matlab_hdf5(const std::string& path,
                                                                    const formats::ImportOptions& options);

}  // namespace dermis::bytes::recordings
