// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "support/random_frames.hpp"
#include "support/temporary_folder.hpp"

/// A mat of 3 x 4 taxels whose readings are newtons, and files of its frames.
namespace dermis::support {

inline constexpr FrameShape kShape{3, 4};
inline constexpr std::size_t kPressed = 5;
inline constexpr Nanos kPeriod = std::chrono::milliseconds(10);

inline ArrayDescription force_mat() {
  ArrayDescription array;
  array.name = "mat";
  array.rows = kShape.rows;
  array.cols = kShape.cols;
  array.row_pitch_m = 0.004;
  array.readout.circuit = Circuit::none;
  array.readout.quantity = Quantity::force;
  array.readout.adc_bits = 24;
  array.readout.adc_noise_counts = 0.001;
  return array;
}

/// A frame every 10 ms from 1 s on, in which one taxel has that reading and all others none.
inline std::vector<RawFrame> pressed(const std::vector<float>& readings, const FrameShape& shape = kShape) {
  std::vector<RawFrame> frames;
  for (const float reading : readings) {
    RawFrame frame;
    frame.time = std::chrono::seconds(1) + static_cast<std::int64_t>(frames.size()) * kPeriod;
    frame.counts.assign(shape.taxel_count(), 0.0F);
    frame.counts[kPressed] = reading;
    frames.push_back(std::move(frame));
  }
  return frames;
}

/// The same, so much later.
inline std::vector<RawFrame> later(std::vector<RawFrame> frames, Nanos delay) {
  for (RawFrame& frame : frames) frame.time += delay;
  return frames;
}

/// array.toml of the mat, which is its model, and files of frames.
class MatFiles {
 public:
  MatFiles() { EXPECT_TRUE(bytes::files::write_array(model(), force_mat())); }

  [[nodiscard]] std::string model() const { return file("array.toml"); }
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.file(name); }
  [[nodiscard]] std::string text_of(const std::string& name) const { return read_bytes(file(name)); }

  /// Returns the path.
  std::string write(const std::string& name, const std::vector<RawFrame>& frames, const FrameShape& shape = kShape,
                    const bytes::recordings::FrameNotes& notes = {}) const {
    const auto sink = bytes::recordings::create_frames(file(name), shape, notes);
    EXPECT_TRUE(sink && write_all(**sink, frames)) << name;
    return file(name);
  }

  /// A recording of two mats, 'left' and 'right'. Returns its path.
  std::string write_two(const std::string& name, const std::vector<RawFrame>& left,
                        const std::vector<RawFrame>& right) const {
    const std::array<const std::vector<RawFrame>*, 2> frames{&left, &right};
    std::vector<std::pair<Nanos, std::pair<std::size_t, std::size_t>>> order;
    for (std::size_t array = 0; array < frames.size(); ++array) {
      for (std::size_t i = 0; i < frames[array]->size(); ++i) order.push_back({(*frames[array])[i].time, {array, i}});
    }
    std::sort(order.begin(), order.end());
    std::vector<bytes::recordings::RecordedArray> arrays(2);
    arrays[0].name = "left";
    arrays[1].name = "right";
    for (bytes::recordings::RecordedArray& array : arrays) array.shape = kShape;
    const auto writer = bytes::recordings::SuitRecordingWriter::create(file(name), arrays, {.live = false});
    EXPECT_TRUE(writer) << name;
    for (const auto& [time, place] : order) {
      EXPECT_TRUE((*writer)->write(place.first, (*frames[place.first])[place.second])) << name;
    }
    EXPECT_TRUE((*writer)->commit()) << name;
    return file(name);
  }

  /// suit.toml of the two, 'right' first.
  [[nodiscard]] std::string suit() const {
    std::string text;
    for (const char* const name : {"right", "left"}) {
      text += std::string("[[array]]\nname = \"") + name + "\"\nfrom = \"sim:idle?rate=10\"\nmodel = \"array.toml\"\n";
    }
    write_bytes(file("suit.toml"), text);
    return file("suit.toml");
  }

 private:
  TemporaryFolder folder_;
};

template <typename Value>
std::string error_of(const Result<Value>& result) {
  return result ? "no error" : result.error().message;
}

}  // namespace dermis::support
