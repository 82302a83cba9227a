// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
/// Writes the recording of a day as the recorder does, a chunk of all arrays each 50 ms of its frames, as fast as the
/// disk takes it, and prints the memory hour by hour.
/// Usage: long_recording FILE [HOURS [ARRAYS]]
#include <fmt/core.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "need.hpp"

namespace dermis {
namespace {

constexpr std::chrono::nanoseconds kChunkTime = std::chrono::milliseconds(50);
constexpr FrameShape kShape{16, 16};

struct Array {
  std::string name;
  std::uint16_t acquisition = 0;
  std::uint16_t image = 0;
};

double resident_megabytes() {
  std::size_t total = 0;
  std::size_t resident = 0;
  std::ifstream("/proc/self/statm") >> total >> resident;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

std::vector<Array> declare_arrays(bytes::recordings::McapWriter& mcap, std::size_t count) {
  const auto declare = [&](const std::string& topic, const bytes::ros_messages::MessageType& type) {
    return mcap.add_channel({topic, "cdr", type.name, "ros2msg", type.definition});
  };
  std::vector<Array> arrays;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = "array" + std::to_string(i);
    arrays.push_back({name, declare('/' + name + "/acquisition", bytes::ros_messages::acquisition_type()),
                      declare('/' + name + "/raw", bytes::ros_messages::image_type())});
  }
  return arrays;
}

void add_frames(bytes::recordings::McapWriter& mcap, const std::vector<Array>& arrays, const RawFrame& frame) {
  static std::vector<std::uint8_t> message;
  const auto sequence = static_cast<std::uint32_t>(*frame.acquisition.sequence);
  const auto log_time = static_cast<std::uint64_t>(frame.time.count());
  for (const Array& array : arrays) {
    bytes::ros_messages::encode_acquisition(frame, message);
    mcap.add_message({array.acquisition, sequence, log_time, log_time, message});
    bytes::ros_messages::encode_image(frame, kShape, array.name, message);
    mcap.add_message({array.image, sequence, log_time, log_time, message});
  }
}

void write_recording(const std::string& path, std::uint64_t hours, std::size_t array_count) {
  constexpr std::uint64_t kChunksAnHour = std::chrono::hours(1) / kChunkTime;
  const auto mcap = need(bytes::recordings::McapWriter::create(path, bytes::recordings::McapCompression::lz4));
  const std::vector<Array> arrays = declare_arrays(*mcap, array_count);
  RawFrame frame;
  frame.counts.assign(kShape.taxel_count(), 1000);
  for (std::uint64_t i = 1; i <= hours * kChunksAnHour; ++i) {
    frame.time += kChunkTime;
    frame.acquisition.sequence = i;
    frame.counts[i % frame.counts.size()] = static_cast<float>(1000 + i % 50);
    add_frames(*mcap, arrays, frame);
    need(mcap->close_chunk());
    need(mcap->appear());
    if (i % kChunksAnHour == 0) fmt::print("{:3} h  {:8.2f} MB\n", i / kChunksAnHour, resident_megabytes());
  }
  const auto begin = std::chrono::steady_clock::now();
  need(mcap->finish());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  fmt::print("end    {:8.2f} MB, written in {:.1f} s; the file has {:.0f} MB\n", resident_megabytes(), took.count(),
             static_cast<double>(std::filesystem::file_size(path)) / 1e6);
}

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: {} FILE [HOURS [ARRAYS]]\n", argv[0]);
    return 2;
  }
  const std::uint64_t hours = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 24;
  const std::size_t arrays = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 8;
  dermis::write_recording(argv[1], hours, arrays);
  return 0;
}
