// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::datasets {

/// Numbers that were sampled beside the frames, such as joint angles, each by its name.
class SampledSeries {
 public:
  /// A CSV with time_s, whose times rise; the other columns are the numbers.
  [[nodiscard]] static Result<SampledSeries> read(const std::string& csv);
  /// The joints of a topic of a recording. A message may have only some; one that is no number is not there.
  [[nodiscard]] static Result<SampledSeries> read_topic(const std::string& recording, const std::string& topic);

  [[nodiscard]] std::vector<std::string> names() const;
  /// Puts the numbers into the order of these names. False where there are others.
  [[nodiscard]] bool reorder(const std::vector<std::string>& names);
  /// From the first time of any number to the last one.
  [[nodiscard]] std::pair<Nanos, Nanos> range() const;
  /// The longest time between two samples of the number that has most of them.
  [[nodiscard]] Nanos longest_gap() const;
  /// Appends, of each name, the newest number of that time or earlier, or else its first one.
  void append(Nanos time, std::vector<std::byte>& row) const;

 private:
  struct Numbers {
    std::string name;
    std::vector<Nanos> times{};
    std::vector<float> values{};
  };
  std::vector<Numbers> numbers_;
};

}  // namespace dermis::out::datasets
