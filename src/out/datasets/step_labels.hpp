// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/out/datasets/episode_sink.hpp"

namespace dermis::out::datasets {

/// Marks of people in the recordings (docs/recordings.md), as labels of the steps. Not thread-safe.
class StepLabels {
 public:
  /// `order`: in which the recordings come; names are numbered in it. `cut`: each must have a label.
  [[nodiscard]] static Result<StepLabels> read(const std::vector<std::string>& recordings,
                                               const std::vector<std::size_t>& order, bool cut);

  /// Empty: nobody has marked anything.
  [[nodiscard]] std::optional<Column> column() const;
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

  /// The next steps are of this recording.
  void begin(std::size_t number) { marks_ = &recordings_[number]; }
  /// The index of the label in force; -1: none.
  [[nodiscard]] std::int64_t at(Nanos step) const;
  /// Its name; "": none.
  [[nodiscard]] std::string name_at(Nanos step) const;
  void append(std::span<const Nanos> steps, std::vector<std::byte>& values) const;
  /// So many of these steps, from the first on, lie between the same two marks. At least one of some.
  [[nodiscard]] std::size_t steps_of_span(std::span<const Nanos> steps) const;
  /// A mark lies between these steps.
  [[nodiscard]] bool is_between(Nanos step, Nanos next) const { return after(step) != after(next); }
  /// Says when the arrays were tared while they were recorded, behind the `first` frame; "": they were not.
  [[nodiscard]] std::string tare_notice(const std::string& from, Nanos first) const;

 private:
  struct Span {
    Nanos begin{};
    std::int64_t label = -1;
  };
  struct Marks {
    std::vector<Span> spans;  ///< By time.
    std::vector<Nanos> tares;
  };
  [[nodiscard]] Marks taken(const std::vector<bytes::ros_messages::Mark>& marks);
  [[nodiscard]] std::size_t after(Nanos time) const;

  std::vector<std::string> names_;
  std::vector<Marks> recordings_;
  const Marks* marks_ = nullptr;
};

}  // namespace dermis::out::datasets
