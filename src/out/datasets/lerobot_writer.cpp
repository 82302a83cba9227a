// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/out/datasets/summary.hpp"
#include "out/datasets/column_statistics.hpp"
#include "out/datasets/dataset_writers.hpp"
#include "out/datasets/lerobot_tables.hpp"
#include "out/datasets/lerobot_tasks.hpp"

// The layout of LeRobot 0.4: "v3.0".
namespace dermis::out::datasets {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kBytesOfFile = std::uint64_t{100} << 20U;  // a new file then begins with the next episode
constexpr std::size_t kFilesOfChunk = 1000;
constexpr std::array kQuantileNames = {"q01", "q10", "q50", "q90", "q99"};

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

class LeRobotWriter final : public EpisodeSink {
 public:
  LeRobotWriter(std::unique_ptr<OutputFolder> folder, DatasetOptions options)
      : folder_(std::move(folder)), options_(std::move(options)) {}

  Status begin(const std::vector<Column>& columns) override {
    columns_ = columns;
    const std::vector<Column> own = own_columns();
    columns_.insert(columns_.end(), own.begin(), own.end());
    Json plan = {{"columns", Json::array()}, {"bytes_of_file", kBytesOfFile}, {"files_of_chunk", kFilesOfChunk}};
    for (const Column& column : columns_) {
      statistics_.emplace_back(column);
      const bool is_number = column.shape == std::vector<std::size_t>{1};
      plan["columns"].push_back({{"name", feature_of(column)},
                                 {"type", dtype(column.type)},
                                 {"shape", is_number ? Json::array() : Json(column.shape)}});
    }
    of_episode_ = statistics_;
    tasks_ = LeRobotTasks(columns, options_.task);
    auto tables = LeRobotTables::start(options_.python, folder_->place(""));
    if (!tables) return tables.error();
    tables_ = *std::move(tables);
    return tables_->send_line(plan.dump());
  }

  Status write(const StepBlock& block) override {
    const std::vector<std::vector<std::byte>> own = own_values(block);
    std::vector<std::span<const std::byte>> values(block.values.begin(), block.values.end());
    values.insert(values.end(), own.begin(), own.end());
    if (Status told = tables_->send_line(Json({{"steps", block.steps}}).dump()); !told) return told;
    for (const std::span<const std::byte> column : values) {
      if (Status sent = tables_->send(column); !sent) return sent;
    }
    learn::calibration::parallel_for(columns_.size(), [&](std::size_t k) { of_episode_[k].add(values[k]); });
    steps_of_episode_ += block.steps;
    return Done{};
  }

  Status end_episode() override {
    Json statistics = Json::array();
    for (const ColumnStatistics& of : of_episode_) statistics.push_back(statistics_of(of));
    const Json episode = {{"index", episode_++},
                          {"length", steps_of_episode_},
                          {"from", steps_},
                          {"tasks", tasks_.take_of_episode()},
                          {"statistics", statistics}};
    steps_ += std::exchange(steps_of_episode_, 0);
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      statistics_[k].add(of_episode_[k]);
      of_episode_[k].clear();
    }
    return tables_->send_line(Json({{"episode", episode}}).dump());
  }

  Status commit(const EpisodeTally& tally) override {
    Status done = tables_->finish(Json({{"tasks", tasks_.all()}}).dump());
    if (done) done = folder_->write("meta/stats.json", stats().dump(1));
    if (done) done = folder_->write("meta/info.json", info(tally).dump(4));
    return done ? folder_->commit(tally, "meta/") : done;
  }

 private:
  /// Lists with a number of each kind.
  [[nodiscard]] static Json statistics_of(const ColumnStatistics& of) {
    Json all = Json::object();
    for (std::size_t k = 0; k < of.kinds(); ++k) {
      const ColumnStatistics::OfKind kind = of.of_kind(k);
      all["min"].push_back(kind.lowest);
      all["max"].push_back(kind.highest);
      all["mean"].push_back(kind.mean);
      all["std"].push_back(kind.deviation);
      for (std::size_t q = 0; q < kQuantileNames.size(); ++q) all[kQuantileNames[q]].push_back(kind.quantiles[q]);
    }
    return all;
  }

  std::vector<std::vector<std::byte>> own_values(const StepBlock& block) {
    std::vector<std::vector<std::byte>> values(own_columns().size());
    for (std::size_t k = 0; k < block.steps; ++k) {
      const std::size_t step = steps_of_episode_ + k;
      append(static_cast<float>(static_cast<double>(step) / options_.fps), values[0]);
      append(static_cast<std::int64_t>(step), values[1]);
      append(static_cast<std::int64_t>(episode_), values[2]);
      append(static_cast<std::int64_t>(steps_ + step), values[3]);
      append(tasks_.of_step(block, k), values[4]);
    }
    return values;
  }

  /// Policies that normalise by the deviation of a taxel that nobody touches would see noise of 1. So the names that
  /// LeRobot reads hold the numbers of all elements of a kind, and names of their own those of each element.
  [[nodiscard]] Json stats() const {
    Json all = Json::object();
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const ColumnStatistics& of = statistics_[k];
      const auto list = [&](const auto& number) {
        std::size_t next = 0;
        return nested(columns_[k].shape, 0, next, number);
      };
      Json& column = all[feature_of(columns_[k])];
      const Json kinds = statistics_of(of);
      for (const auto& [name, values] : kinds.items()) {
        column[name] = list([&](std::size_t i) { return values[i % of.kinds()]; });
      }
      column["count"] = Json::array({steps_});
      if (of.kinds() == of.elements()) continue;
      column["element_min"] = list([&](std::size_t i) { return of.lowest(i); });
      column["element_max"] = list([&](std::size_t i) { return of.highest(i); });
      column["element_mean"] = list([&](std::size_t i) { return of.mean(i); });
      column["element_std"] = list([&](std::size_t i) { return of.deviation(i); });
    }
    return all;
  }

  [[nodiscard]] Json info(const EpisodeTally& tally) const {
    Json features = Json::object();
    for (const Column& column : columns_) {
      const Json names = column.axes.empty() ? Json(nullptr) : Json(column.axes);
      features[feature_of(column)] = {{"dtype", dtype(column.type)}, {"shape", column.shape}, {"names", names}};
    }
    Json splits = {{"train", split_text(tally, false)}};
    if (tally.held_out > 0) splits["val"] = split_text(tally, true);
    const bool is_whole = std::floor(options_.fps) == options_.fps;
    return {{"codebase_version", "v3.0"},
            {"robot_type", "dermis"},
            {"total_episodes", episode_},
            {"total_frames", steps_},
            {"total_tasks", tasks_.all().size()},
            {"chunks_size", kFilesOfChunk},
            {"data_files_size_in_mb", kBytesOfFile >> 20U},
            {"video_files_size_in_mb", 200},
            {"fps", is_whole ? Json(static_cast<std::int64_t>(options_.fps)) : Json(options_.fps)},
            {"splits", splits},
            {"data_path", "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"},
            {"video_path", nullptr},
            {"features", features}};
  }

  std::unique_ptr<OutputFolder> folder_;
  DatasetOptions options_;
  std::vector<Column> columns_;               ///< Those of LeRobot at the end.
  std::vector<ColumnStatistics> statistics_;  ///< Of the episodes that have ended.
  std::vector<ColumnStatistics> of_episode_;
  std::unique_ptr<LeRobotTables> tables_;
  LeRobotTasks tasks_;
  std::size_t episode_ = 0;
  std::size_t steps_ = 0;  ///< Of the episodes that have ended.
  std::size_t steps_of_episode_ = 0;
};

}  // namespace

std::unique_ptr<EpisodeSink> lerobot_writer(std::unique_ptr<OutputFolder> folder, const DatasetOptions& options) {
  return std::make_unique<LeRobotWriter>(std::move(folder), options);
}

}  // namespace dermis::out::datasets
