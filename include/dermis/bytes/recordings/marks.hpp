// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Marks of a recording: moments with a name (docs/recordings.md). They are messages of its topic /marks. Once somebody
/// has edited them, those of people are in a CSV beside it, which counts alone.
namespace dermis::bytes::recordings {

inline constexpr const char* kMarksTopic = "/marks";
inline constexpr std::size_t kMostMarks = 100'000;
inline constexpr std::size_t kMostLabelBytes = 200;

/// "walk.mcap" -> "walk.marks.csv"
[[nodiscard]] std::string marks_path(const std::string& recording);

/// The marks of people and the events of the server, by time. `start`: time of the first frame, from which the CSV
/// counts. A recording without index is read to its end. At most kMostMarks.
[[nodiscard]] Result<std::vector<ros_messages::Mark>> read_marks(const std::string& recording, Nanos start);

/// Writes those of people beside the recording. Fails on a label that is too long or holds what a CSV cannot.
[[nodiscard]] Status write_marks(const std::string& recording, Nanos start, std::span<const ros_messages::Mark> marks);

}  // namespace dermis::bytes::recordings
