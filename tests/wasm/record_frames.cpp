// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Records frames of 32x32 taxels at 100 Hz into hour.mcap, as quickly as it can, and says so. The page calls it piece
// by piece.
#include <cstdint>
#include <memory>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace {

using namespace dermis;  // NOLINT(google-build-using-namespace)
using bytes::recordings::SuitRecordingWriter;

constexpr std::size_t kSide = 32;
constexpr Nanos kPeriod = std::chrono::milliseconds(10);

struct Recording {
  std::unique_ptr<SuitRecordingWriter> writer;
  RawFrame frame;
};

Recording& recording() {
  static Recording recording;
  return recording;
}

/// Counts that do not repeat.
void fill(RawFrame& frame, std::uint64_t number) {
  frame.time = std::chrono::hours(500'000) + static_cast<std::int64_t>(number) * kPeriod;
  frame.counts.resize(kSide * kSide);
  std::uint64_t state = number * 0x9E3779B97F4A7C15U + 1;
  for (float& count : frame.counts) {
    state ^= state << 13U;
    state ^= state >> 7U;
    state ^= state << 17U;
    count = static_cast<float>(state & 4095U);
  }
}

}  // namespace

#define DERMIS_EXPORT(name) extern "C" __attribute__((export_name(#name)))

DERMIS_EXPORT(begin) int begin() {
  bytes::recordings::RecordedArray array;
  array.name = "hour";
  array.shape = {kSide, kSide};
  auto writer = SuitRecordingWriter::create("/recordings/hour.mcap", {array});
  if (writer) recording().writer = *std::move(writer);
  return writer ? 1 : 0;
}

/// The frames from `first` on. Returns how many are in the recording.
DERMIS_EXPORT(record) int record(int first, int count) {
  for (int k = 0; k < count; ++k) {
    fill(recording().frame, static_cast<std::uint64_t>(first + k));
    const Result<bool> written = recording().writer->try_write(0, recording().frame);
    if (!written || !*written) return k;
  }
  return count;
}

DERMIS_EXPORT(end) int end() {
  const Status ended = recording().writer->commit();
  recording().writer.reset();
  return ended ? 1 : 0;
}
