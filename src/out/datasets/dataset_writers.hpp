// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>

#include "dermis/out/datasets/dataset_files.hpp"
#include "out/datasets/output_folder.hpp"

namespace dermis::out::datasets {

/// One source file each.
[[nodiscard]] std::unique_ptr<EpisodeSink> lerobot_writer(std::unique_ptr<OutputFolder> folder,
                                                          const DatasetOptions& options);
[[nodiscard]] std::unique_ptr<EpisodeSink> hdf5_writer(std::unique_ptr<OutputFolder> folder, bool is_robomimic);
[[nodiscard]] std::unique_ptr<EpisodeSink> zarr_writer(std::unique_ptr<OutputFolder> folder);

}  // namespace dermis::out::datasets
