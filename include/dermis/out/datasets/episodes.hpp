// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dermis/out/datasets/episode_sink.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Recordings as episodes for learning (docs/datasets.md).
namespace dermis::out::datasets {

/// At once, in the column "contacts".
inline constexpr std::size_t kContactsOfStep = 8;

struct EpisodeOptions {
  double fps = 30.0;       ///< Steps a second, 0.001 ... 10000.
  std::size_t window = 1;  ///< Frames of each array in a step, 1 ... 1000.
  bool flat = false;       ///< Every column has one dimension.
  /// Quantities to have: "forces", "sigma", "valid", "raw", "age", "fresh", "contacts", "temperature", "supply". Empty:
  /// all that there are.
  std::vector<std::string> quantities{};
  /// Path as for bytes::models::read_model(); of recordings of several arrays, of the suit.toml that names theirs.
  /// Empty: each recording has the model that it holds; if one holds none, there are no forces.
  std::string model{};
  /// Takes the first second of each recording as unloaded; fails where a load stands there, and without a model.
  bool tare = false;
  bool tare_force = false;    ///< The same, whatever stands there.
  bool follow_drift = false;  ///< Follows the offsets of idle taxels.
  /// The robot's state, such as joint angles, and its actions. Either is a topic of sensor_msgs/msg/JointState that all
  /// recordings have ("/joint_states"), or a CSV for each. time_s of a CSV is on the clock of the frames. Each step has
  /// the newest numbers.
  std::vector<std::string> states{};
  std::vector<std::string> actions{};
  /// Without states, the only topic that all recordings have is the state, if its joints are the same in each.
  bool finds_state = true;
  /// Times of the steps of each recording, which rise, in place of `fps`. Those of a single recording may be of several
  /// episodes, one after the other. Each begins before the last frame and ends after the first. Empty: those of a
  /// clock.
  std::vector<std::vector<Nanos>> times{};
  /// Episodes that are not trained on: a share of them such as "0.2", or recordings by their paths or names. They
  /// become the last ones.
  std::vector<std::string> hold_out{};
  /// Each span of a label (docs/recordings.md) is an episode, and what has no label is left out. Needs the clock of
  /// `fps`, and a label in each recording.
  bool cut = false;
  const std::atomic<bool>* stop = nullptr;                ///< Set: ends the work, and nothing is written.
  std::function<void(const std::string&)> notice{};       ///< Receives one line on what a user should know.
  std::function<void(const std::string&)> loss{};         ///< Receives one line, if a file is cut off at its end.
  std::function<void(std::uint64_t steps)> progressed{};  ///< Told now and then how many steps there are.

  /// Names the first field that is wrong.
  [[nodiscard]] Status validate() const;
};

/// No array is silent for longer than this within an episode: such a gap ends it.
inline constexpr Nanos kLongestGap = std::chrono::seconds(10);

/// Every recording, or other file of frames, becomes an episode, in one pass; the memory does not grow with its length.
/// All must have the same arrays. Forces are those of `dermis run` with the same tare and drift. Calls sink.commit() at
/// the end.
[[nodiscard]] Result<EpisodeTally> make_episodes(const std::vector<std::string>& recordings,
                                                 const EpisodeOptions& options, EpisodeSink& sink);

/// When the steps of a recording may begin: half a frame after the first of the array that first has two. So the frames
/// of an even rate lie between steps.
[[nodiscard]] Result<Nanos> first_step(const std::string& recording, double fps);

}  // namespace dermis::out::datasets
