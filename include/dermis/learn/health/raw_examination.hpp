// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::learn::health {

/// The verdict of raw counts on an array of which no model is known.
struct RawDiagnosis {
  std::size_t frames = 0;
  double seconds = 0.0;                  ///< From the first to the last frame [s].
  float least_counts = 0.0F;             ///< The lowest reading; 0 before the first frame.
  float most_counts = 0.0F;              ///< The highest one.
  std::vector<std::string> findings;     ///< On the whole array, each with its likely cause and the mend.
  std::vector<std::string> stuck_lines;  ///< The same on lines at an end of the ADC.
  /// On taxels at full scale, which a press may explain: no problems() where nothing else is known of the array.
  std::vector<std::string> stuck_taxels;
  std::optional<std::string> remark;  ///< That all readings are 0, which may be a fault or not.

  [[nodiscard]] std::vector<std::string> problems() const;  ///< The findings, then the stuck lines.
};

/// Looks for mistakes of the electronics in raw counts alone. Lines may read the same because an address line does not
/// switch, or readings keep a share of the one before. It also finds readings of two values only, lines that stand or
/// break, inputs that float, hum, and arrays without power. Clocks may restart, jump or count in another unit. Memory
/// does not grow with the frames. Not thread-safe.
class RawExamination {
 public:
  /// `readout`: as far as it is known; empty: nothing of it is.
  explicit RawExamination(FrameShape shape, const std::optional<Readout>& readout = std::nullopt);
  RawExamination(RawExamination&&) noexcept;
  RawExamination& operator=(RawExamination&&) noexcept;
  ~RawExamination();

  /// A frame of that shape; its readings may be anything.
  void add(const RawFrame& raw);

  /// The verdict of all frames so far.
  [[nodiscard]] RawDiagnosis diagnosis() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// As lines of text: what was read, then the findings or a line that there are none.
[[nodiscard]] std::string describe(const RawDiagnosis& diagnosis, FrameShape shape);

}  // namespace dermis::learn::health
