// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::recognising {

/// Readings beside the frames of a recording that have times of their own, such as joint angles. Not thread-safe.
class FurtherReadings {
 public:
  /// Reads CSV as docs/recognition.md describes it: `time_s` on the clock of the frames and a column a reading. Where
  /// there is a column `recording`, only its lines with this name count. A cell that is empty or "nan" is a reading
  /// that is missing.
  [[nodiscard]] static Result<FurtherReadings> read(const std::string& path, const std::string& recording);

  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

  /// Goes on to the time of a frame, which may not fall.
  void move_to(Nanos time);

  /// The last values that are not later; NaN where there is none, or none for learn::recognition::kLongestSilence.
  [[nodiscard]] const std::vector<float>& values() const noexcept { return values_; }

  /// A line where some were missing.
  [[nodiscard]] std::optional<std::string> describe_missing() const;

 private:
  FurtherReadings() = default;

  std::string path_;
  std::string recording_;
  std::vector<std::string> names_;
  std::vector<Nanos> times_;  ///< Of the lines.
  std::vector<float> lines_;  ///< [lines, names]
  std::size_t next_ = 0;      ///< The first line that is later.
  std::vector<float> last_;   ///< Of each name, however old.
  std::vector<Nanos> last_times_;
  std::vector<float> values_;
  std::size_t frames_ = 0;
  std::size_t frames_with_missing_ = 0;
};

}  // namespace dermis::recognising
