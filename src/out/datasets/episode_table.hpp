// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dermis/touch/frames/result.hpp"
#include "out/datasets/column_statistics.hpp"
#include "out/datasets/parquet_file.hpp"

namespace dermis::out::datasets {

/// meta/episodes of LeRobot: where each episode is, and the statistics of its columns. Not thread-safe.
class EpisodeTable {
 public:
  static constexpr std::array kNumbers = {
      "episode_index",      "length",           "data/chunk_index",          "data/file_index",
      "dataset_from_index", "dataset_to_index", "meta/episodes/chunk_index", "meta/episodes/file_index"};
  struct Feature {
    std::string name;
    std::vector<std::size_t> shape;
  };

  [[nodiscard]] static Result<std::unique_ptr<EpisodeTable>> create(const std::string& path,
                                                                    const std::vector<Feature>& features);
  /// `statistics`: of each feature.
  [[nodiscard]] Status add(const std::array<std::int64_t, kNumbers.size()>& numbers, const std::string& task,
                           const std::vector<ColumnStatistics>& statistics);
  [[nodiscard]] Status finish() { return file_->finish(); }

 private:
  explicit EpisodeTable(std::unique_ptr<ParquetFile> file) : file_(std::move(file)) {}

  std::unique_ptr<ParquetFile> file_;
};

}  // namespace dermis::out::datasets
