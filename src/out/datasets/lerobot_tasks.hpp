// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dermis/out/datasets/episode_sink.hpp"

namespace dermis::out::datasets {

/// The tasks of LeRobot: labels and, for steps without one, a sentence for all. Not thread-safe.
class LeRobotTasks {
 public:
  LeRobotTasks() = default;
  LeRobotTasks(const std::vector<Column>& columns, const std::string& sentence);

  /// The index of the task of a step of this block.
  [[nodiscard]] std::int64_t of_step(const StepBlock& block, std::size_t step);
  /// Those of the steps since the last call.
  [[nodiscard]] std::vector<std::string> take_of_episode();
  /// All by their index; the sentence only if a step has it.
  [[nodiscard]] std::vector<std::string> all() const;

 private:
  std::size_t label_column_ = 0;
  std::size_t labels_ = 0;
  std::vector<std::string> tasks_;  ///< The labels, and the sentence where it is none.
  std::size_t of_others_ = 0;       ///< Of steps without a label.
  bool has_others_ = false;
  std::vector<bool> in_episode_;
};

}  // namespace dermis::out::datasets
