// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "dermis/bytes/recordings/hdf5_tables.hpp"
#include "out/datasets/dataset_writers.hpp"

namespace dermis::out::datasets {
namespace {

using bytes::recordings::Hdf5Tables;

Hdf5Tables::Number number_of(ColumnType type) {
  switch (type) {
    case ColumnType::float32: return Hdf5Tables::Number::float32;
    case ColumnType::int64: return Hdf5Tables::Number::int64;
    case ColumnType::boolean: break;
  }
  return Hdf5Tables::Number::uint8;
}

/// ACT has a file for each episode, robomimic a group of one file.
class Hdf5Writer final : public EpisodeSink {
 public:
  Hdf5Writer(std::unique_ptr<OutputFolder> folder, bool is_robomimic)
      : folder_(std::move(folder)), is_robomimic_(is_robomimic) {}

  Status begin(const std::vector<Column>& columns) override {
    columns_ = columns;
    return Done{};
  }

  Status write(const StepBlock& block) override {
    if (tables_.empty()) {
      if (Status begun = begin_episode(); !begun) return begun;
    }
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (Status appended = file_->append(tables_[k], block.steps, block.values[k].data()); !appended) return appended;
    }
    steps_ += block.steps;
    return Done{};
  }

  Status end_episode() override {
    Status ended = is_robomimic_ ? end_demo() : end_file();
    tables_.clear();
    ++episode_;
    all_steps_ += steps_;
    steps_ = 0;
    return ended;
  }

  Status commit(const EpisodeTally& tally) override {
    if (is_robomimic_ && file_ != nullptr) {
      if (Status ended = end_demos(tally); !ended) return ended;
    }
    return folder_->commit(tally, "");
  }

 private:
  [[nodiscard]] std::string group() const { return "/data/demo_" + std::to_string(episode_); }

  [[nodiscard]] std::string name_of(const Column& column) const {
    if (column.name() == "state") return is_robomimic_ ? group() + "/obs/joint_pos" : "/observations/qpos";
    if (column.name() == "action") return is_robomimic_ ? group() + "/actions" : "/action";
    if (is_robomimic_) return group() + (column.array.empty() ? "/" : "/obs/tactile_") + column.name();
    return (column.array.empty() ? "/" : "/observations/tactile/") + column.name();
  }

  Status begin_episode() {
    if (file_ == nullptr) {
      const std::string name = is_robomimic_ ? "demo.hdf5" : "episode_" + std::to_string(episode_) + ".hdf5";
      auto file = Hdf5Tables::create(folder_->place(name));
      if (!file) return file.error();
      file_ = *std::move(file);
      if (Status told = write_labels(); !told) return told;
    }
    for (const Column& column : columns_) {
      const Result<std::size_t> table = file_->add(name_of(column), number_of(column.type), column.shape);
      if (!table) return table.error();
      tables_.push_back(*table);
      const std::string axes = nlohmann::json(column.axes).dump();
      if (Status named = file_->set_text(name_of(column), "axes", axes); !named) return named;
    }
    return Done{};
  }

  Status write_labels() {
    for (const Column& column : columns_) {
      if (column.labels.empty()) continue;
      if (Status told = file_->set_text("/", "labels", nlohmann::json(column.labels).dump()); !told) return told;
    }
    return Done{};
  }

  Status end_file() {
    Status told = file_->set_flag("/", "sim", false);
    if (told) told = file_->commit();
    file_.reset();
    return told;
  }

  Status end_demo() { return file_->set_number(group(), "num_samples", static_cast<std::int64_t>(steps_)); }

  /// Robomimic takes the names of the demonstrations to train on, or to validate with, from a mask.
  Status write_mask(const char* name, std::uint64_t first, std::uint64_t end) {
    std::vector<std::string> demos;
    for (std::uint64_t k = first; k < end; ++k) demos.push_back("demo_" + std::to_string(k));
    return file_->write_names(name, demos);
  }

  Status end_demos(const EpisodeTally& tally) {
    if (tally.held_out > 0) {
      const std::uint64_t trained = tally.episodes - tally.held_out;
      Status masked = write_mask("/mask/train", 0, trained);
      if (masked) masked = write_mask("/mask/valid", trained, tally.episodes);
      if (!masked) return masked;
    }
    Status told = file_->set_number("/data", "total", static_cast<std::int64_t>(all_steps_));
    const nlohmann::json environment = {
        {"env_name", "dermis"}, {"env_type", 2}, {"env_kwargs", nlohmann::json::object()}};
    if (told) told = file_->set_text("/data", "env_args", environment.dump());
    return told ? file_->commit() : told;
  }

  std::unique_ptr<OutputFolder> folder_;
  bool is_robomimic_;
  std::vector<Column> columns_;
  std::unique_ptr<Hdf5Tables> file_;
  std::vector<std::size_t> tables_;  ///< Those of the episode; empty before its first step.
  std::size_t episode_ = 0;
  std::size_t steps_ = 0;
  std::size_t all_steps_ = 0;
};

}  // namespace

std::unique_ptr<EpisodeSink> hdf5_writer(std::unique_ptr<OutputFolder> folder, bool is_robomimic) {
  return std::make_unique<Hdf5Writer>(std::move(folder), is_robomimic);
}

}  // namespace dermis::out::datasets
