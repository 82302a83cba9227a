// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
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
  /// Elements are of so many kinds, over and over; those of a kind have their statistics in common. 0: none have.
  std::size_t kinds = 0;
  std::vector<std::string> labels{};  ///< Names of the values 0, 1, ...; -1 has none. Empty: of a quantity.

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

/// The frames of an array, counted.
///
/// Many members: a summary shows each.
struct ArrayTally {
  std::string name;
  std::size_t rows = 0;
  std::size_t cols = 0;
  bool has_forces = false;  ///< Values are newtons, not counts.
  std::uint64_t frames = 0;
  std::uint64_t missed = 0;              ///< In no window.
  std::size_t most_fresh = 0;            ///< New in one step: a window so long misses none.
  std::uint64_t most_of_episode = 0;     ///< Frames.
  Nanos time{};                          ///< From the first frame to the last of each episode, in all.
  std::uint64_t episodes = 0;            ///< With a frame.
  std::uint64_t steps = 0;               ///< With a frame in the window.
  std::uint64_t stale_steps = 0;         ///< Those without a new one.
  Nanos age{};                           ///< The ages of the newest frame at these steps, added up.
  Nanos oldest{};                        ///< The largest age of the newest frame.
  std::uint64_t late_frames = 0;         ///< Earlier than one before, and in no window.
  std::uint64_t empty_frames = 0;        ///< Others without any value.
  std::vector<std::uint64_t> invalid{};  ///< Other frames in which a taxel has no value [rows, cols].
  float lowest = 0.0F;                   ///< The lowest value.
  float highest = 0.0F;                  ///< The highest value.
  std::vector<float> first_picture{};    ///< Values [rows, cols]; NaN where there is none.
  std::vector<float> last_picture{};     ///< The same.
};

struct EpisodeSource {
  std::string recording;
  std::uint64_t steps = 0;
  Nanos first{};  ///< The first step.
  Nanos last{};
  std::string label{};  ///< That cut the episode out; empty: none.
};

struct EpisodeTally {
  std::uint64_t episodes = 0;
  std::uint64_t steps = 0;
  std::vector<ArrayTally> arrays{};
  std::vector<EpisodeSource> sources{};  ///< One for each episode.
  std::uint64_t gaps = 0;                ///< That ended an episode.
  std::uint64_t held_out = 0;            ///< So many episodes at the end.
  std::vector<std::string> labels{};     ///< As Column::labels of the column "label".
  /// How they were made, for people: "window", "5 frames".
  std::vector<std::pair<std::string, std::string>> how{};
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
  /// Once, after the last episode; `tally` is of all. Without it, no file remains.
  [[nodiscard]] virtual Status commit(const EpisodeTally& tally) = 0;
};

}  // namespace dermis::out::datasets
