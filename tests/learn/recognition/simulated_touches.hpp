// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "dermis/learn/recognition/examples.hpp"
#include "dermis/touch/frames/random.hpp"

/// Touches of a few plain kinds, for tests.
namespace dermis::learn::recognition::support {

inline Layout one_array(std::size_t rows, std::size_t cols, double pitch_mm = 0.0, double rate_hz = 0.0) {
  Layout layout;
  layout.arrays = {{"skin", rows, cols, 0, pitch_mm, pitch_mm}};
  layout.readings = rows * cols;
  layout.rate_hz = rate_hz;
  return layout;
}

/// An elliptic contact; lengths as those of the pitch (taxels where it is 1).
struct Ellipse {
  double row = 0.0;
  double col = 0.0;
  double along_rows = 1.0;
  double along_cols = 1.0;
  double force = 1000.0;
};

/// Adds the contact to a frame: taxel r, c is at (r + 1/2, c + 1/2) pitches.
inline void press(std::vector<float>& frame, std::size_t rows, std::size_t cols, double pitch, const Ellipse& contact) {
  const double area = pitch * pitch / (contact.along_rows * contact.along_cols);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t col = 0; col < cols; ++col) {
      const double y = ((static_cast<double>(row) + 0.5) * pitch - contact.row) / contact.along_rows;
      const double x = ((static_cast<double>(col) + 0.5) * pitch - contact.col) / contact.along_cols;
      frame[row * cols + col] += static_cast<float>(contact.force * area * std::exp(-0.5 * (y * y + x * x)));
    }
  }
}

/// The kinds of pose(): small, large, long, two.
inline constexpr std::size_t kPoses = 4;
inline const char* pose_name(std::size_t kind) {
  constexpr const char* kNames[kPoses] = {"small", "large", "long", "two"};
  return kNames[kind];
}

/// One frame of a contact of some kind, somewhere on an area of 12 x 10 lengths.
inline std::vector<float> pose(Random& random, std::size_t kind, double pitch = 1.0) {
  const auto rows = static_cast<std::size_t>(std::lround(12.0 / pitch));
  const auto cols = static_cast<std::size_t>(std::lround(10.0 / pitch));
  Ellipse contact{random.uniform(4.0, 8.0), random.uniform(4.0, 6.0), 0.8, 0.8, random.uniform(700.0, 1400.0)};
  if (kind == 1) contact.along_rows = contact.along_cols = random.uniform(1.6, 2.0);
  if (kind == 2) contact.along_rows = random.uniform(2.2, 2.8);
  std::vector<float> frame(rows * cols);
  if (kind == 3) {
    contact.row = random.uniform(2.0, 4.0);
    press(frame, rows, cols, pitch, contact);
    contact.row += random.uniform(4.5, 6.0);
  }
  press(frame, rows, cols, pitch, contact);
  for (float& reading : frame) reading = std::max(reading + static_cast<float>(random.normal()), 0.0F);
  return frame;
}

/// `each` poses of every kind, in turns; where `sessions` is not 0 in so many sessions.
inline LabelledFrames poses(std::size_t each, std::uint64_t seed, std::size_t sessions = 0) {
  Random random(seed);
  LabelledFrames data;
  data.layout = one_array(12, 10);
  for (std::size_t i = 0; i < each * kPoses; ++i) {
    const std::vector<float> frame = pose(random, i % kPoses);
    data.frames.insert(data.frames.end(), frame.begin(), frame.end());
    const std::string group = sessions == 0 ? "" : std::to_string(i / kPoses % sessions);
    data.labels.push_back({"p" + std::to_string(i), i, i, pose_name(i % kPoses), group, static_cast<double>(i)});
  }
  return data;
}

/// `each` taps, holds and strokes of different length on an array of 8 x 16.
inline LabelledFrames gestures(std::size_t each, std::uint64_t seed) {
  constexpr const char* kNames[] = {"tap", "hold", "stroke"};
  Random random(seed);
  LabelledFrames data;
  data.layout = one_array(8, 16);
  for (std::size_t i = 0; i < 3 * each; ++i) {
    const std::size_t kind = i % 3;
    const auto frames = static_cast<std::size_t>(random.uniform(20.0, 30.0));
    const std::size_t first = data.frame_count();
    const double begin = random.uniform(3.0, 5.0);
    for (std::size_t frame = 0; frame < frames; ++frame) {
      const double share = static_cast<double>(frame) / static_cast<double>(frames - 1);
      const bool is_off = kind == 0 && frame / 4 % 2 == 1;
      const double col = kind == 2 ? begin + 8.0 * share : begin + 3.0;
      std::vector<float> readings(data.layout.readings);
      if (!is_off) press(readings, 8, 16, 1.0, {4.0, col, 1.2, 1.2, 1000.0 * std::sin(3.0 * share + 0.05)});
      for (float& reading : readings) reading = std::max(reading + static_cast<float>(random.normal()), 0.0F);
      data.frames.insert(data.frames.end(), readings.begin(), readings.end());
    }
    data.labels.push_back(
        {"g" + std::to_string(i), first, first + frames - 1, kNames[kind], "", static_cast<double>(i)});
  }
  return data;
}

inline std::vector<std::size_t> all_labels(const LabelledFrames& data) {
  std::vector<std::size_t> all(data.labels.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

}  // namespace dermis::learn::recognition::support
