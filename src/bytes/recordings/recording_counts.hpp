// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::bytes::recordings {

/// The frames of one topic of images.
struct FrameCounts {
  std::uint64_t frames = 0;
  std::uint64_t lost = 0;
  std::optional<FrameShape> shape;
  std::uint64_t first_log_time = 0;
  std::uint64_t last_log_time = 0;
};

/// The counts of the messages of a file, as they go by.
class RecordingCounts {
 public:
  void count(const McapMessage& message, const McapChannel& channel);

  [[nodiscard]] const std::map<std::uint16_t, std::uint64_t>& messages() const noexcept { return messages_; }
  /// Why the first image is no frame that is none; empty: all are.
  [[nodiscard]] const std::string& unread() const noexcept { return unread_; }
  /// Counts of the images in a folder of topics.
  [[nodiscard]] FrameCounts in_folder(const std::string& folder) const;
  /// Counts of the first topic of images; losses are those of all topics.
  [[nodiscard]] FrameCounts first() const;

 private:
  struct Images {
    std::uint16_t channel = 0;
    FrameCounts counts;
  };

  std::map<std::uint16_t, std::uint64_t> messages_;
  std::map<std::string, Images> images_;       ///< By folder.
  std::map<std::string, std::uint64_t> lost_;  ///< By folder.
  std::optional<std::string> first_folder_;
  std::string unread_;
  RawFrame frame_;  ///< What was decoded last.
};

}  // namespace dermis::bytes::recordings
