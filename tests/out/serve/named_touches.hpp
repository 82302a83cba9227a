// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/recognition/learning.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/reference_array.hpp"

/// Touches of an array, in newtons, and the classes that are learned of them.
namespace dermis::out::serve {

inline constexpr std::size_t kTouchRows = 8;
inline constexpr std::size_t kTouchCols = 6;

inline ArrayDescription touched_array() {
  return support::reference_array(kTouchRows, kTouchCols);
}

/// A frame with a press of two taxels on the "left" or the "right", and noise.
inline std::vector<float> touch(Random& random, bool is_left, double newtons) {
  std::vector<float> frame(kTouchRows * kTouchCols);
  for (float& force : frame) force = static_cast<float>(0.005 * random.normal());
  const auto row = static_cast<std::size_t>(random.uniform(2.0, 5.0));
  const std::size_t first = row * kTouchCols + (is_left ? 1 : 4);
  frame[first] += static_cast<float>(newtons);
  frame[first + kTouchCols] += static_cast<float>(newtons);
  return frame;
}

inline learn::recognition::Classes learned(learn::recognition::LabelledFrames data) {
  const ArrayDescription array = touched_array();
  data.layout.arrays = {{"skin", kTouchRows, kTouchCols, 0, 1e3 * array.row_pitch_m, 1e3 * array.col_pitch_m}};
  data.layout.readings = array.taxel_count();
  data.layout.quantity = Quantity::force;
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < data.labels.size(); ++k) all.push_back(k);
  const Result<learn::recognition::LearningSet> set = learn::recognition::LearningSet::create(data);
  EXPECT_TRUE(set) << set.error().message;
  Result<learn::recognition::Learned> learned = set->learn(all);
  EXPECT_TRUE(learned) << learned.error().message;
  learned->classes.touches = learn::recognition::learn_touches(data);
  return std::move(learned->classes);
}

inline void append(learn::recognition::LabelledFrames& data, const std::vector<float>& frame) {
  data.frames.insert(data.frames.end(), frame.begin(), frame.end());
}

/// Poses: "left" and "right".
inline learn::recognition::Classes left_and_right() {
  Random random(1);
  learn::recognition::LabelledFrames data;
  for (std::size_t k = 0; k < 24; ++k) {
    append(data, touch(random, k % 2 == 0, random.uniform(2.0, 6.0)));
    data.labels.push_back({std::to_string(k), k, k, k % 2 == 0 ? "left" : "right", "", static_cast<double>(k)});
  }
  return learned(std::move(data));
}

/// The course of a "tap" (a tenth of a second) or a "hold" (half a second) that begins at 0 s [N].
inline double course(bool is_tap, double seconds) {
  return seconds >= 0.0 && seconds < (is_tap ? 0.1 : 0.5) ? 4.0 : 0.0;
}

/// Gestures: "tap" and "hold", at 100 Hz.
inline learn::recognition::Classes taps_and_holds() {
  Random random(2);
  learn::recognition::LabelledFrames data;
  data.layout.rate_hz = 100.0;
  for (std::size_t k = 0; k < 24; ++k) {
    const bool is_tap = k % 2 == 0;
    const std::size_t first = 100 * k + 30;
    for (int frame = 0; frame < 100; ++frame) {
      append(data, touch(random, true, random.uniform(0.8, 1.2) * course(is_tap, 0.01 * (frame - 30))));
    }
    data.labels.push_back(
        {std::to_string(k), first, first + (is_tap ? 9 : 49), is_tap ? "tap" : "hold", "", static_cast<double>(k)});
  }
  return learned(std::move(data));
}

inline ForceFrame force_frame(Nanos time, std::vector<float> newtons) {
  ForceFrame frame;
  frame.time = time;
  frame.sigma_newtons.assign(newtons.size(), 0.01F);
  frame.signal_to_noise.assign(newtons.size(), 0.0F);
  for (std::size_t k = 0; k < newtons.size(); ++k) frame.signal_to_noise[k] = newtons[k] / 0.01F;
  frame.taxels.assign(newtons.size(), TaxelStatus::ok);
  frame.newtons = std::move(newtons);
  return frame;
}

}  // namespace dermis::out::serve
