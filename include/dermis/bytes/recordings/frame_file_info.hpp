// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/recording.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::recordings {

/// The content of a file of frames; empty if its format does not contain it. Many members: `dermis info` shows each.
struct FrameFileInfo {
  FrameFormat format = FrameFormat::csv;
  std::uint64_t bytes = 0;  ///< 0 of a pipe.
  std::uint64_t frames = 0;
  std::optional<FrameShape> shape;
  std::optional<double> duration_s;  ///< From the first to the last frame; a clock that restarts counts on.
  std::optional<Nanos> start_utc;    ///< Time of the first, since 1970.
  std::optional<std::uint64_t> lost;
  std::vector<std::string> doubts;  ///< On the times, a sentence each, where all frames are read.
  bool complete = true;             ///< Written to its end.
  std::optional<std::pair<double, double>> temperature_celsius;  ///< Lowest and highest of mean_celsius().
  FrameNotes notes;
  std::string compression;  ///< Of a recording.
  std::string software;
  std::vector<RecordedArrayInfo> arrays;  ///< If there are several: shape and notes are then theirs.
  std::vector<RecordingTopic> topics;
  std::string unread;  ///< As RecordingInfo::unread.

  /// Frames a second; only for one array, because several have rates of their own.
  [[nodiscard]] std::optional<double> rate_hz() const;
};

/// For a recording from its summary, if it has one; for other files by reading all frames. A file without a frame is
/// bad input. "rec.mcap#chest" is one array of a recording. `shape`: required shape of the frames, needed if the file
/// does not contain it.
[[nodiscard]] Result<FrameFileInfo> frame_file_info(const std::string& path,
                                                    const std::optional<FrameShape>& shape = std::nullopt);

/// The same of bytes that a layout describes; `format`, `bytes` and `notes` stay as they are.
[[nodiscard]] Result<FrameFileInfo> frame_source_info(FrameSource& source);

}  // namespace dermis::bytes::recordings
