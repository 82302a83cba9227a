// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/learn/recognition/segment.hpp"
#include "dermis/touch/frames/result.hpp"

/// The examples that classes are learned from.
namespace dermis::learn::recognition {

/// A segment of a recording whose class a person has named. Frames count from 0; both are within.
struct Label {
  std::string id{};
  std::size_t first = 0;
  std::size_t last = 0;
  std::string name{};  ///< Name of the class: UTF-8 without control characters, and not "unknown".
  std::string
      group{};         ///< Subject or session, which are never in training and test at once; empty where none is named.
  double order = 0.0;  ///< Place in time.
};

/// All frames of a recording, and the labels of some.
struct LabelledFrames {
  Layout layout;
  std::vector<float> frames;  ///< [frames, layout.readings]
  std::vector<float> extras;  ///< [frames, layout.extras]
  std::vector<Label> labels;

  [[nodiscard]] std::size_t frame_count() const noexcept { return frames.size() / layout.readings; }
  [[nodiscard]] Segment segment(const Label& label) const;
  /// Frames of the longest label; at least 1.
  [[nodiscard]] std::size_t longest() const;

  /// Fails on labels that lie outside of the frames, end before they begin or overlap, and on an id that stands twice.
  [[nodiscard]] Status check_labels() const;
  /// Fail on readings, or further readings, that are no numbers.
  [[nodiscard]] Status check_frames() const;
  [[nodiscard]] Status check_extras() const;
  /// All of these, and what is wrong with the layout.
  [[nodiscard]] Status validate() const;
};

/// The image of an example, [readings]: the mean of its frames with at least half of its largest force. Readings that
/// are no load are 0.
[[nodiscard]] std::vector<float> held_image(const LabelledFrames& data, const Label& label);

}  // namespace dermis::learn::recognition
