// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "out/datasets/column_statistics.hpp"
#include "out/datasets/dataset_writers.hpp"
#include "out/datasets/episode_table.hpp"
#include "out/datasets/in_parallel.hpp"
#include "out/datasets/parquet_file.hpp"

// The layout of LeRobot 0.4: "v3.0".
namespace dermis::out::datasets {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostWaitingBytes = std::size_t{16} << 20U;
constexpr std::uint64_t kBytesOfFile = std::uint64_t{100} << 20U;  // a new file then begins with the next episode
constexpr std::size_t kFilesOfChunk = 1000;

ParquetType parquet_type(ColumnType type) {
  switch (type) {
    case ColumnType::float32: return ParquetType::float32;
    case ColumnType::int64: return ParquetType::int64;
    case ColumnType::boolean: break;
  }
  return ParquetType::boolean;
}

const char* dtype(ColumnType type) {
  switch (type) {
    case ColumnType::float32: return "float32";
    case ColumnType::int64: return "int64";
    case ColumnType::boolean: break;
  }
  return "bool";
}

std::string feature_of(const Column& column) {
  if (column.name() == "state") return "observation.state";
  return (column.array.empty() ? "" : "observation.tactile.") + column.name();
}

/// The columns that LeRobot gives each step itself.
std::vector<Column> own_columns() {
  std::vector<Column> columns{{"", "timestamp", ColumnType::float32, {1}, {}}};
  for (const char* const name : {"frame_index", "episode_index", "index", "task_index"}) {
    columns.push_back({"", name, ColumnType::int64, {1}, {}});
  }
  return columns;
}

/// Numbers of elements as lists in lists.
template <typename Of>
Json nested(const std::vector<std::size_t>& shape, std::size_t depth, std::size_t& next, const Of& of) {
  Json list = Json::array();
  for (std::size_t k = 0; k < shape[depth]; ++k) {
    list.push_back(depth + 1 == shape.size() ? Json(of(next++)) : nested(shape, depth + 1, next, of));
  }
  return list;
}

template <typename T>
void append(T value, std::vector<std::byte>& bytes) {
  const auto* const first = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof value);
}

std::span<const std::byte> bytes_of_text(const std::string& text) {
  return std::as_bytes(std::span(text));
}

class LeRobotWriter final : public EpisodeSink {
 public:
  LeRobotWriter(std::unique_ptr<OutputFolder> folder, DatasetOptions options)
      : folder_(std::move(folder)), options_(std::move(options)) {}

  Status begin(const std::vector<Column>& columns) override {
    columns_ = columns;
    const std::vector<Column> own = own_columns();
    columns_.insert(columns_.end(), own.begin(), own.end());
    std::vector<EpisodeTable::Feature> features;
    for (const Column& column : columns_) {
      statistics_.emplace_back(column);
      features.push_back({feature_of(column), column.shape});
    }
    of_episode_ = statistics_;
    auto episodes = EpisodeTable::create(folder_->place("meta/episodes/chunk-000/file-000.parquet"), features);
    if (!episodes) return episodes.error();
    episodes_ = *std::move(episodes);
    return Done{};
  }

  Status write(const StepBlock& block) override {
    if (file_ == nullptr) {
      if (Status opened = open_file(); !opened) return opened;
    }
    const std::vector<std::vector<std::byte>> own = own_values(block.steps);
    std::vector<std::span<const std::byte>> values(block.values.begin(), block.values.end());
    values.insert(values.end(), own.begin(), own.end());
    file_->write(block.steps, values);
    in_parallel(columns_.size(), [&](std::size_t k) { of_episode_[k].add(values[k]); });
    steps_of_episode_ += block.steps;
    return file_->waiting_bytes() > kMostWaitingBytes ? file_->end_row_group() : Status(Done{});
  }

  Status end_episode() override {
    const auto from = static_cast<std::int64_t>(steps_);
    steps_ += steps_of_episode_;
    const auto length = static_cast<std::int64_t>(std::exchange(steps_of_episode_, 0));
    Status added = episodes_->add(
        {static_cast<std::int64_t>(episode_++), length, static_cast<std::int64_t>(file_index_ / kFilesOfChunk),
         static_cast<std::int64_t>(file_index_ % kFilesOfChunk), from, static_cast<std::int64_t>(steps_), 0, 0},
        options_.task, of_episode_);
    if (!added) return added;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      statistics_[k].add(of_episode_[k]);
      of_episode_[k] = ColumnStatistics(columns_[k]);
    }
    if (Status ended = file_->end_row_group(); !ended) return ended;
    return file_->bytes() > kBytesOfFile ? close_file() : Status(Done{});
  }

  Status commit() override {
    Status done = file_ == nullptr ? Status(Done{}) : close_file();
    if (done) done = write_tasks();
    if (done) done = episodes_->finish();
    if (done) done = folder_->write("meta/stats.json", stats().dump(1));
    if (done) done = folder_->write("meta/info.json", info().dump(4));
    return done ? folder_->commit() : done;
  }

 private:
  Status open_file() {
    std::vector<ParquetColumn> columns;
    for (const Column& column : columns_) {
      const bool is_number = column.shape == std::vector<std::size_t>{1};
      columns.push_back(
          {feature_of(column), parquet_type(column.type), is_number ? std::vector<std::size_t>() : column.shape});
    }
    const std::string name =
        fmt::format("data/chunk-{:03}/file-{:03}.parquet", file_index_ / kFilesOfChunk, file_index_ % kFilesOfChunk);
    auto file = ParquetFile::create(folder_->place(name), std::move(columns));
    if (!file) return file.error();
    file_ = *std::move(file);
    return Done{};
  }

  Status close_file() {
    Status finished = file_->finish();
    file_.reset();
    ++file_index_;
    return finished;
  }

  [[nodiscard]] std::vector<std::vector<std::byte>> own_values(std::size_t steps) const {
    std::vector<std::vector<std::byte>> values(own_columns().size());
    for (std::size_t k = 0; k < steps; ++k) {
      const std::size_t step = steps_of_episode_ + k;
      append(static_cast<float>(static_cast<double>(step) / options_.fps), values[0]);
      append(static_cast<std::int64_t>(step), values[1]);
      append(static_cast<std::int64_t>(episode_), values[2]);
      append(static_cast<std::int64_t>(steps_ + step), values[3]);
      append(std::int64_t{0}, values[4]);
    }
    return values;
  }

  /// A table of pandas whose index are the sentences.
  Status write_tasks() const {
    auto file = ParquetFile::create(folder_->place("meta/tasks.parquet"),
                                    {{"task_index", ParquetType::int64}, {"task", ParquetType::text}});
    if (!file) return file.error();
    const std::int64_t index = 0;
    const std::string task = plain_text(options_.task);
    const std::vector<std::span<const std::byte>> values = {std::as_bytes(std::span(&index, 1)), bytes_of_text(task)};
    (*file)->write(1, values);
    const auto column = [](const char* name, const char* pandas, const char* numpy) {
      return Json{
          {"name", name}, {"field_name", name}, {"pandas_type", pandas}, {"numpy_type", numpy}, {"metadata", nullptr}};
    };
    const Json pandas = {
        {"index_columns", Json::array({"task"})},
        {"column_indexes", Json::array()},
        {"columns", Json::array({column("task_index", "int64", "int64"), column("task", "unicode", "object")})},
        {"pandas_version", "2.0.0"}};
    return (*file)->finish({{"pandas", pandas.dump()}});
  }

  [[nodiscard]] Json stats() const {
    Json all = Json::object();
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const ColumnStatistics& of = statistics_[k];
      const auto list = [&](const auto& number) {
        std::size_t next = 0;
        return nested(columns_[k].shape, 0, next, number);
      };
      all[feature_of(columns_[k])] = {{"min", list([&](std::size_t i) { return of.lowest(i); })},
                                      {"max", list([&](std::size_t i) { return of.highest(i); })},
                                      {"mean", list([&](std::size_t i) { return of.mean(i); })},
                                      {"std", list([&](std::size_t i) { return of.deviation(i); })},
                                      {"count", Json::array({steps_})}};
    }
    return all;
  }

  [[nodiscard]] Json info() const {
    Json features = Json::object();
    for (const Column& column : columns_) {
      const Json names = column.axes.empty() ? Json(nullptr) : Json(column.axes);
      features[feature_of(column)] = {{"dtype", dtype(column.type)}, {"shape", column.shape}, {"names", names}};
    }
    const bool is_whole = std::floor(options_.fps) == options_.fps;
    return {{"codebase_version", "v3.0"},
            {"robot_type", "dermis"},
            {"total_episodes", episode_},
            {"total_frames", steps_},
            {"total_tasks", 1},
            {"chunks_size", kFilesOfChunk},
            {"data_files_size_in_mb", kBytesOfFile >> 20U},
            {"video_files_size_in_mb", 200},
            {"fps", is_whole ? Json(static_cast<std::int64_t>(options_.fps)) : Json(options_.fps)},
            {"splits", {{"train", fmt::format("0:{}", episode_)}}},
            {"data_path", "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"},
            {"video_path", nullptr},
            {"features", features}};
  }

  std::unique_ptr<OutputFolder> folder_;
  DatasetOptions options_;
  std::vector<Column> columns_;               ///< Those of LeRobot at the end.
  std::vector<ColumnStatistics> statistics_;  ///< Of the episodes that have ended.
  std::vector<ColumnStatistics> of_episode_;
  std::unique_ptr<ParquetFile> file_;
  std::size_t file_index_ = 0;
  std::unique_ptr<EpisodeTable> episodes_;
  std::size_t episode_ = 0;
  std::size_t steps_ = 0;  ///< Of the episodes that have ended.
  std::size_t steps_of_episode_ = 0;
};

}  // namespace

std::unique_ptr<EpisodeSink> lerobot_writer(std::unique_ptr<OutputFolder> folder, const DatasetOptions& options) {
  return std::make_unique<LeRobotWriter>(std::move(folder), options);
}

}  // namespace dermis::out::datasets
