// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/lerobot_tasks.hpp"

#include <algorithm>
#include <cstring>

namespace dermis::out::datasets {

LeRobotTasks::LeRobotTasks(const std::vector<Column>& columns, const std::string& sentence) {
  const auto label = std::ranges::find_if(columns, [](const Column& column) { return !column.labels.empty(); });
  if (label != columns.end()) tasks_ = label->labels;
  label_column_ = static_cast<std::size_t>(label - columns.begin());
  labels_ = tasks_.size();
  of_others_ = static_cast<std::size_t>(std::ranges::find(tasks_, sentence) - tasks_.begin());
  if (of_others_ == labels_) tasks_.push_back(sentence);
  in_episode_.resize(tasks_.size());
}

std::int64_t LeRobotTasks::of_step(const StepBlock& block, std::size_t step) {
  std::int64_t label = -1;
  if (labels_ > 0) std::memcpy(&label, block.values[label_column_].data() + step * sizeof label, sizeof label);
  const std::size_t task = label < 0 ? of_others_ : static_cast<std::size_t>(label);
  has_others_ = has_others_ || label < 0;
  in_episode_[task] = true;
  return static_cast<std::int64_t>(task);
}

std::vector<std::string> LeRobotTasks::take_of_episode() {
  std::vector<std::string> tasks;
  for (std::size_t k = 0; k < tasks_.size(); ++k) {
    if (in_episode_[k]) tasks.push_back(tasks_[k]);
  }
  in_episode_.assign(tasks_.size(), false);
  return tasks;
}

std::vector<std::string> LeRobotTasks::all() const {
  std::vector<std::string> tasks = tasks_;
  if (!has_others_) tasks.resize(labels_);
  return tasks;
}

}  // namespace dermis::out::datasets
