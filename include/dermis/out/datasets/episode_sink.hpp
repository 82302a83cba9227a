// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::out::datasets {

enum class ColumnType : std::uint8_t {
  float32,
  int64,
  boolean,  ///< A byte, 0 or 1.
};

/// Bytes of one number.
[[nodiscard]] constexpr std::size_t bytes_of(ColumnType type) noexcept {
  return type == ColumnType::boolean ? 1 : type == ColumnType::float32 ? sizeof(float) : sizeof(std::int64_t);
}

/// A quantity that each step has.
struct Column {
  std::string array;     ///< "chest"; empty: of the step itself.
  std::string quantity;  ///< "sigma"; empty: the forces of the array.
  ColumnType type = ColumnType::float32;
  std::vector<std::size_t> shape;  ///< That of one step; {1} for a number.
  std::vector<std::string> axes;   ///< "window", "rows", "cols": one for each dimension.

  [[nodiscard]] std::size_t elements() const noexcept;
  [[nodiscard]] std::size_t row_bytes() const noexcept { return elements() * bytes_of(type); }
  /// "chest_sigma", "time_ns"
  [[nodiscard]] std::string name() const;
};

/// Steps that follow each other in an episode.
struct StepBlock {
  std::size_t steps = 0;
  std::vector<std::vector<std::byte>> values;  ///< Of each column: steps times row_bytes().
};

/// Where episodes go: a dataset in files, or memory.
class EpisodeSink {
 public:
  EpisodeSink() = default;
  EpisodeSink(const EpisodeSink&) = delete;
  EpisodeSink& operator=(const EpisodeSink&) = delete;
  virtual ~EpisodeSink() = default;

  /// Once, before all steps.
  [[nodiscard]] virtual Status begin(const std::vector<Column>& columns) = 0;
  [[nodiscard]] virtual Status write(const StepBlock& block) = 0;
  /// The steps since the end of the episode before, at least one.
  [[nodiscard]] virtual Status end_episode() = 0;
  /// Once, after the last episode. Without it, no file remains.
  [[nodiscard]] virtual Status commit() = 0;
};

}  // namespace dermis::out::datasets
