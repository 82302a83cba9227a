// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/out/datasets/summary.hpp"
#include "out/datasets/dataset_writers.hpp"
#include "out/datasets/zstd.hpp"

namespace dermis::out::datasets {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kBytesOfChunk = std::size_t{1} << 20U;
constexpr std::size_t kMostStepsOfChunk = 16'384;

const char* dtype(ColumnType type) {
  switch (type) {
    case ColumnType::float32: return "<f4";
    case ColumnType::int64: return "<i8";
    case ColumnType::boolean: break;
  }
  return "|b1";
}

/// `row_shape`: of one row.
std::string array_json(std::size_t rows, std::size_t rows_of_chunk, const std::vector<std::size_t>& row_shape,
                       ColumnType type) {
  std::vector<std::size_t> shape{rows};
  std::vector<std::size_t> chunks{rows_of_chunk};
  for (std::vector<std::size_t>* const list : {&shape, &chunks}) {
    list->insert(list->end(), row_shape.begin(), row_shape.end());
  }
  const Json compressor = {{"id", "zstd"}, {"level", kZstdLevel}};
  const Json fill = type == ColumnType::boolean ? Json(false) : Json(0);
  return Json{{"zarr_format", 2},         {"shape", shape},     {"chunks", chunks}, {"dtype", dtype(type)},
              {"compressor", compressor}, {"fill_value", fill}, {"order", "C"},     {"filters", nullptr}}
      .dump(2);
}

/// A column in chunks of whole steps.
class ZarrColumn {
 public:
  ZarrColumn(Column column, const OutputFolder& folder)
      : column_(std::move(column)),
        folder_(folder),
        name_("data/" + std::string(column_.array.empty() ? "" : "tactile_") + column_.name()),
        steps_of_chunk_(std::clamp<std::size_t>(kBytesOfChunk / column_.row_bytes(), 1, kMostStepsOfChunk)) {}

  [[nodiscard]] Status append(std::span<const std::byte> values) {
    const std::size_t chunk = steps_of_chunk_ * column_.row_bytes();
    steps_ += values.size() / column_.row_bytes();
    while (!values.empty()) {
      const std::size_t taken = std::min(values.size(), chunk - bytes_.size());
      bytes_.insert(bytes_.end(), values.begin(), values.begin() + static_cast<std::ptrdiff_t>(taken));
      values = values.subspan(taken);
      if (bytes_.size() < chunk) break;
      if (Status written = write_chunk(); !written) return written;
    }
    return Done{};
  }

  /// The last chunk is filled up with zeros.
  [[nodiscard]] Status finish() {
    if (!bytes_.empty()) {
      bytes_.resize(steps_of_chunk_ * column_.row_bytes());
      if (Status written = write_chunk(); !written) return written;
    }
    // A number is an array of one dimension to those who index it by steps alone, so {1} stays a dimension.
    Status described =
        folder_.write(name_ + "/.zarray", array_json(steps_, steps_of_chunk_, column_.shape, column_.type));
    if (!described) return described;
    return folder_.write(name_ + "/.zattrs", Json{{"axes", column_.axes}}.dump(2));
  }

 private:
  [[nodiscard]] Status write_chunk() {
    std::string key = std::to_string(chunks_++);
    for (std::size_t k = 0; k < column_.shape.size(); ++k) key += ".0";
    Status written = folder_.write(name_ + "/" + key, zstd_compressed(bytes_));
    bytes_.clear();
    return written;
  }

  Column column_;
  const OutputFolder& folder_;
  std::string name_;
  std::size_t steps_of_chunk_;
  std::vector<std::byte> bytes_;
  std::size_t steps_ = 0;
  std::size_t chunks_ = 0;
};

class ZarrWriter final : public EpisodeSink {
 public:
  explicit ZarrWriter(std::unique_ptr<OutputFolder> folder) : folder_(std::move(folder)) {}

  Status begin(const std::vector<Column>& columns) override {
    for (const Column& column : columns) columns_.emplace_back(column, *folder_);
    for (const char* const group : {".zgroup", "data/.zgroup", "meta/.zgroup"}) {
      if (Status written = folder_->write(group, Json{{"zarr_format", 2}}.dump(2)); !written) return written;
    }
    return Done{};
  }

  Status write(const StepBlock& block) override {
    steps_ += static_cast<std::int64_t>(block.steps);
    return for_each([&](std::size_t k) { return columns_[k].append(block.values[k]); });
  }

  Status end_episode() override {
    episode_ends_.push_back(steps_);
    return Done{};
  }

  Status commit(const EpisodeTally& tally) override {
    Status finished = for_each([&](std::size_t k) { return columns_[k].finish(); });
    if (!finished) return finished;
    const std::string ends = "meta/episode_ends";
    Status described = folder_->write(ends + "/.zarray",
                                      array_json(episode_ends_.size(), episode_ends_.size(), {}, ColumnType::int64));
    if (!described) return described;
    Status written = folder_->write(ends + "/0", zstd_compressed(std::as_bytes(std::span(episode_ends_))));
    if (!written) return written;
    Json splits = {{"train", split_text(tally, false)}};
    if (tally.held_out > 0) splits["val"] = split_text(tally, true);
    Json attributes = {{"splits", splits}};
    if (!tally.labels.empty()) attributes["labels"] = tally.labels;
    if (Status told = folder_->write(".zattrs", attributes.dump(2)); !told) return told;
    return folder_->commit(tally, "");
  }

 private:
  template <typename Work>
  [[nodiscard]] Status for_each(Work work) {
    std::vector<Status> done(columns_.size(), Done{});
    learn::calibration::parallel_for(columns_.size(), [&](std::size_t k) { done[k] = work(k); });
    const auto failure = std::find_if(done.begin(), done.end(), [](const Status& status) { return !status; });
    return failure == done.end() ? Status(Done{}) : *failure;
  }

  std::unique_ptr<OutputFolder> folder_;
  std::vector<ZarrColumn> columns_;
  std::vector<std::int64_t> episode_ends_;
  std::int64_t steps_ = 0;
};

}  // namespace

std::unique_ptr<EpisodeSink> zarr_writer(std::unique_ptr<OutputFolder> folder) {
  return std::make_unique<ZarrWriter>(std::move(folder));
}

}  // namespace dermis::out::datasets
