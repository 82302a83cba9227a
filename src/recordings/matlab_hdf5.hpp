// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/core/frame_source.hpp"
#include "dermis/core/result.hpp"
#include "dermis/importers/import_options.hpp"

namespace dermis::recordings {

/// The file is one of MATLAB 7.3, which is HDF5.
[[nodiscard]] bool is_matlab_hdf5(const std::string& path);

/// Its frames, found as importers::open_matlab() does.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_matlab_hdf5(const std::string& path,
                                                                    const importers::ImportOptions& options);

}  // namespace dermis::recordings
