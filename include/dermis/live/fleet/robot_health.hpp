// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::fleet {

/// The state of an array at work. Many members: lists show each of them.
struct ArrayHealth {
  enum class Level : std::uint8_t { good, warning, error, ended };

  std::string name;
  FrameShape shape{};
  std::string model{};  ///< Its name; empty: none.
  Level level = Level::good;
  std::string message{};                ///< Why: "healthy", "2 faults".
  Nanos since{};                        ///< Level and message are so since then, by UTC; 0: not known.
  double rate_hz = 0.0;                 ///< Frames a second that come from the source.
  std::uint64_t lost = 0;               ///< Frames that the source lost.
  std::uint64_t left_out = 0;           ///< Frames that were not published, as the server did not follow.
  std::uint64_t masked_taxels = 0;      ///< Without a force: dead, or on faulty lines.
  std::optional<double> gain_change{};  ///< From taxel to taxel since the calibration, 0.09 is 9 %; empty: not known.
  bool wants_calibration = false;
  std::uint64_t damaged = 0;       ///< Frames that came damaged.
  std::uint64_t late = 0;          ///< Frames for which the machine had no time, or that came after later ones.
  std::uint64_t wanted_model = 0;  ///< Number of the model that the fleet wants of it; 0: none.
  std::uint64_t used_model = 0;    ///< The one of the fleet that is in use; 0: none is.
  std::string refusal{};           ///< Why the wanted one is not in use; empty: it is, or will be.
  Nanos refused{};                 ///< It is refused since then, by UTC.

  bool operator==(const ArrayHealth&) const = default;
};

/// The message of a robot that says how it is.
struct RobotHealth {
  Nanos time{};                               ///< By UTC.
  Nanos begun{};                              ///< The robot publishes since then, by UTC; 0: not known.
  Nanos before{};                             ///< It told how it is last before that, by UTC; 0: never, or not known.
  bool is_doubled = false;                    ///< Another robot publishes under the same name.
  std::optional<std::uint64_t> free_bytes{};  ///< On the disk on which it records.
  std::string live{};  ///< Address of its viewer, without a token: "http://anna:8080/"; empty: none.
  std::vector<ArrayHealth> arrays{};

  bool operator==(const RobotHealth&) const = default;

  /// Less than 1 GB is free.
  [[nodiscard]] bool has_little_space() const noexcept { return free_bytes && *free_bytes < 1'000'000'000; }
};

[[nodiscard]] std::string health_to_json(const RobotHealth& health);

/// Accepts any text, of at most 1 MB and 1,000 arrays. Texts are one line, cut at 200 bytes. An address that is none of
/// HTTP reads as empty. Fails on what is no message of health.
[[nodiscard]] Result<RobotHealth> health_from_json(std::string_view text);

}  // namespace dermis::live::fleet
