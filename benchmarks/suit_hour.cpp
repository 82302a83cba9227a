// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
/// Writes a recording of five arrays at 100 Hz from the frames of a file, over and over, for `dermis dataset`.
/// Usage: suit_hour FRAMES OUT.mcap [MINUTES]
#include <fmt/core.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "need.hpp"

namespace dermis {
namespace {

constexpr std::size_t kArrays = 5;
constexpr std::uint64_t kFramesAMinute = 6000;
constexpr Nanos kFrameTime = std::chrono::milliseconds(10);

std::vector<RawFrame> read_frames(const std::string& path) {
  const auto source = need(bytes::recordings::open_frames(path, {}));
  std::vector<RawFrame> frames;
  for (RawFrame frame; need(source->next(frame));) frames.push_back(frame);
  return frames;
}

void write_recording(const std::string& in, const std::string& out, std::uint64_t minutes) {
  std::vector<RawFrame> frames = read_frames(in);
  std::vector<bytes::recordings::RecordedArray> arrays;
  for (std::size_t k = 0; k < kArrays; ++k) arrays.push_back({.name = "array" + std::to_string(k), .shape = {16, 16}});
  const auto recording = need(bytes::recordings::SuitRecordingWriter::create(out, arrays, {.live = false}));
  for (std::uint64_t i = 0; i < minutes * kFramesAMinute; ++i) {
    for (std::size_t k = 0; k < kArrays; ++k) {
      RawFrame& frame = frames[(i + k * frames.size() / kArrays) % frames.size()];
      frame.time = static_cast<std::int64_t>(i) * kFrameTime;
      need(recording->write(k, frame));
    }
  }
  need(recording->commit());
}

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: {} FRAMES OUT.mcap [MINUTES]\n", argv[0]);
    return 2;
  }
  dermis::write_recording(argv[1], argv[2], argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 60);
  return 0;
}
