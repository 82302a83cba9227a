// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dermis/out/datasets/episode_sink.hpp"
#include "dermis/touch/frames/result.hpp"

/// Datasets of episodes in the layouts that policies are trained on (docs/datasets.md).
namespace dermis::out::datasets {

enum class DatasetFormat {
  lerobot,    ///< LeRobot v3: Parquet files, meta/
  hdf5,       ///< ACT: episode_0.hdf5 with /observations, ...
  robomimic,  ///< demo.hdf5 with data/demo_0/obs, ...
  zarr,       ///< Replay buffer of diffusion policy, zarr v2: data/, meta/episode_ends
};

/// In the order of their values.
[[nodiscard]] const std::vector<std::string>& dataset_formats();

/// By its name; fails on another, and lists them.
[[nodiscard]] Result<DatasetFormat> dataset_format(const std::string& name);

struct DatasetOptions {
  DatasetFormat format = DatasetFormat::lerobot;
  double fps = 30.0;
  std::string task = "touch";      ///< LeRobot has one sentence for each episode.
  std::string python = "python3";  ///< The interpreter that has pyarrow, which writes those of LeRobot.
};

/// A dataset in the new folder `folder`, which appears complete or not at all. Fails where it exists and is not empty.
[[nodiscard]] Result<std::unique_ptr<EpisodeSink>> create_dataset(const std::string& folder,
                                                                  const DatasetOptions& options);

}  // namespace dermis::out::datasets
