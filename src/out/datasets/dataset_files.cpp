// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/datasets/dataset_files.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "dermis/bytes/files/text.hpp"
#include "out/datasets/dataset_writers.hpp"

namespace dermis::out::datasets {

const std::vector<std::string>& dataset_formats() {
  static const std::vector<std::string> kNames = {"lerobot", "hdf5", "robomimic", "zarr"};
  return kNames;
}

Result<DatasetFormat> dataset_format(const std::string& name) {
  const std::vector<std::string>& names = dataset_formats();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    return bad_field("format", fmt::format("{} is none of {}", bytes::files::in_quotes(name), fmt::join(names, ", ")));
  }
  return static_cast<DatasetFormat>(found - names.begin());
}

Result<std::unique_ptr<EpisodeSink>> create_dataset(const std::string& folder, const DatasetOptions& options) {
  Result<std::unique_ptr<OutputFolder>> created = OutputFolder::create(folder);
  if (!created) return created.error();
  switch (options.format) {
    case DatasetFormat::lerobot: return lerobot_writer(*std::move(created), options);
    case DatasetFormat::hdf5: return hdf5_writer(*std::move(created), false);
    case DatasetFormat::robomimic: return hdf5_writer(*std::move(created), true);
    case DatasetFormat::zarr: break;
  }
  return zarr_writer(*std::move(created));
}

}  // namespace dermis::out::datasets
