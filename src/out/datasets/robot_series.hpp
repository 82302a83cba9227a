// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/out/datasets/episodes.hpp"
#include "out/datasets/sampled_series.hpp"

namespace dermis::out::datasets {

/// The state or the actions of a robot in each recording. Not thread-safe.
class RobotSeries {
 public:
  /// `quantity`: "state" or "action". `from`: a CSV for each recording, or a topic that all have.
  RobotSeries(std::string quantity, std::vector<std::string> from)
      : quantity_(std::move(quantity)), from_(std::move(from)) {}

  /// Those that the options name and, where they name no state, the joints that the recordings have.
  [[nodiscard]] static Result<std::vector<RobotSeries>> choose(const std::vector<std::string>& recordings,
                                                               const EpisodeOptions& options);

  /// Reads those of a recording. Fails where their names are not those of the first.
  [[nodiscard]] Status read(const std::string& recording, std::size_t number);
  /// A column of a step, once they are read.
  [[nodiscard]] Column column() const { return {"", quantity_, ColumnType::float32, {names_.size()}, names_}; }
  /// The row of a step, whose times rise.
  void append(Nanos step, std::vector<std::byte>& row);
  /// Once the steps of the recording are appended: one line on those that have no number of their own, or "". Fails
  /// where the numbers are of another time than the recording, whose frames are from `first` to `last`.
  [[nodiscard]] Result<std::string> check_clock(const std::string& recording, Nanos first, Nanos last) const;

 private:
  std::string quantity_;
  std::vector<std::string> from_;
  std::vector<std::string> names_;
  std::optional<SampledSeries> now_;
  std::string now_from_;
  std::pair<Nanos, Nanos> range_;  ///< The first and the last time of a number.
  // Steps of the recording.
  Nanos lasts_until_{};
  std::uint64_t step_count_ = 0;
  std::uint64_t steps_outside_ = 0;  ///< Before the first number, or behind the last.
  std::pair<Nanos, Nanos> step_range_;
};

}  // namespace dermis::out::datasets
