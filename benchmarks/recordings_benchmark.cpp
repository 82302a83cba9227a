// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Time of one frame of 64x160 taxels written to a recording, and read from it, in blocks of 1000 frames, beside what
// no recorder can do without: copying the readings and compressing them. Processor time counts all threads. Frames are
// those of the simulator's multitouch scene, with the noise of a 12-bit ADC. Usage: store_benchmark [--smoke]
#include <fmt/core.h>
#include <lz4frame.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "dermis/bytes/recordings/recording.hpp"
#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "rows.hpp"
#include "support/reference_array.hpp"

namespace dermis {
namespace {

constexpr FrameShape kShape{64, 160};
constexpr std::size_t kFrameBytes = 2 * kShape.rows * kShape.cols;
constexpr std::size_t kScene = 100;  ///< Frames that are repeated.
constexpr std::size_t kFramesPerChunk = 50;

std::vector<RawFrame> scene_frames() {
  const ArrayDescription array = support::reference_array(kShape.rows, kShape.cols);
  auto simulator = learn::simulation::Simulator::create(array, {}, "multitouch", 1, kScene);
  std::vector<RawFrame> frames(kScene);
  for (RawFrame& frame : frames) {
    if (!simulator.value()->next(frame)) std::abort();
  }
  return frames;
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Of all threads.
double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

/// Measures blocks of frames and keeps the rows of the table.
class Table {
 public:
  explicit Table(bool smoke) : blocks_(smoke ? 1 : 21), frames_(smoke ? 100 : 1000) {
    fmt::print("{:<28}{:<18}{:>12}{:>14}{:>8}{:>9}\n", "work, 64x160", "engine", "us a frame", "processor us", "ratio",
               "checked");
  }

  [[nodiscard]] std::size_t frames() const { return frames_; }

  /// run() handles frames() frames and returns whether all went well; ratio() tells how far they were compressed.
  void measure(const std::string& work, const std::string& engine, const std::function<bool()>& run,
               const std::function<double()>& ratio) {
    bool checked = run();
    std::vector<double> wall;
    std::vector<double> processor;
    for (std::size_t block = 0; block < blocks_; ++block) {
      const double processor_start = processor_seconds();
      const auto start = std::chrono::steady_clock::now();
      checked = run() && checked;
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
      wall.push_back(1e6 * elapsed.count() / static_cast<double>(frames_));
      processor.push_back(1e6 * (processor_seconds() - processor_start) / static_cast<double>(frames_));
    }
    fmt::print("{:<28}{:<18}{:>12.2f}{:>14.2f}{:>8.2f}{:>9}\n", work, engine, upper_median(wall),
               upper_median(processor), ratio(), checked ? "yes" : "NO");
    rows_.push_back({{"work", work + ", 64x160"},
                     {"engine", engine},
                     {"threads", 1},
                     {"median", upper_median(wall)},
                     {"unit", "us"},
                     {"processor_us", upper_median(processor)},
                     {"ratio", ratio()},
                     {"checked", checked}});
  }

  [[nodiscard]] const nlohmann::ordered_json& rows() const { return rows_; }

 private:
  std::size_t blocks_;
  std::size_t frames_;
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

std::string recording_path() {
  return (std::filesystem::temp_directory_path() / "dermis_store_benchmark.mcap").string();
}

bool record(const std::vector<RawFrame>& frames, std::size_t count, bytes::recordings::McapCompression compression) {
  bytes::recordings::RecordingOptions options;
  options.compression = compression;
  const auto writer = bytes::recordings::RecordingWriter::create(recording_path(), kShape, options);
  if (!writer) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (!(*writer)->write(frames[i % kScene])) return false;
  }
  return (*writer)->commit().has_value();
}

bool read(const std::vector<RawFrame>& frames, std::size_t count) {
  const auto reader = bytes::recordings::RecordingReader::open(recording_path());
  if (!reader) return false;
  RawFrame frame;
  for (std::size_t i = 0; i < count; ++i) {
    const Result<bool> got_frame = (*reader)->next(frame);
    if (!got_frame || !*got_frame || frame.counts != frames[i % kScene].counts) return false;
  }
  return true;
}

/// Readings as words, copied into blocks that are compressed one by one.
class Limit {
 public:
  explicit Limit(const std::vector<RawFrame>& frames) : chunk_(kFramesPerChunk * kFrameBytes) {
    for (const RawFrame& frame : frames) words_.emplace_back(frame.counts.begin(), frame.counts.end());
    compressed_.resize(LZ4F_compressFrameBound(chunk_.size(), nullptr));
  }

  bool run(std::size_t count) {
    bool good = true;
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(chunk_.data() + i % kFramesPerChunk * kFrameBytes, words_[i % kScene].data(), kFrameBytes);
      if ((i + 1) % kFramesPerChunk != 0) continue;
      size_ = LZ4F_compressFrame(compressed_.data(), compressed_.size(), chunk_.data(), chunk_.size(), nullptr);
      good = good && LZ4F_isError(size_) == 0;
    }
    return good;
  }

  [[nodiscard]] double ratio() const { return static_cast<double>(chunk_.size()) / static_cast<double>(size_); }

 private:
  std::vector<std::vector<std::uint16_t>> words_;
  std::vector<std::uint8_t> chunk_;
  std::vector<std::uint8_t> compressed_;
  std::size_t size_ = 1;
};

bool benchmark(bool smoke) {
  const std::vector<RawFrame> frames = scene_frames();
  Table table(smoke);
  Limit limit(frames);
  table.measure(
      "copy and compress", "lz4", [&] { return limit.run(table.frames()); }, [&] { return limit.ratio(); });
  const auto file_ratio = [&] {
    return static_cast<double>(table.frames() * kFrameBytes) /
           static_cast<double>(std::filesystem::file_size(recording_path()));
  };
  using bytes::recordings::McapCompression;
  for (const McapCompression compression : {McapCompression::none, McapCompression::lz4, McapCompression::zstd}) {
    const std::string name = compression == McapCompression::none ? "none" : to_string(compression);
    table.measure(
        "record_frame", "dermis, " + name, [&] { return record(frames, table.frames(), compression); }, file_ratio);
    table.measure(
        "read_frame", "dermis, " + name, [&] { return read(frames, table.frames()); }, file_ratio);
  }
  std::filesystem::remove(recording_path());
  return benchmarks::write_rows("store", table.rows());
}

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  return dermis::benchmark(argc == 2 && std::string(argv[1]) == "--smoke") ? 0 : 1;
}
