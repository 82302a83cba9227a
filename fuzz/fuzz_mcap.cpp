// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>
#include <sstream>

#include "check_error.hpp"
#include "dermis/bytes/recordings/recording.hpp"

namespace {

std::unique_ptr<std::istringstream> stream_of(const std::uint8_t* data, std::size_t size) {
  return std::make_unique<std::istringstream>(std::string(reinterpret_cast<const char*>(data), size));
}

/// All arrays, to the end and from the middle again.
void read_suit(const std::uint8_t* data, std::size_t size) {
  const auto suit = dermis::bytes::recordings::SuitRecordingReader::open(stream_of(data, size), "fuzz");
  if (!suit) return;
  dermis::RawFrame frame;
  std::size_t array = 0;
  dermis::Nanos middle{};
  for (int pass = 0; pass < 2; ++pass) {
    for (std::uint64_t frames = 0;; ++frames) {
      const dermis::Result<bool> got_frame = (*suit)->next(array, frame);
      if (!got_frame) dermis::fuzz::check_error(got_frame.error());
      if (!got_frame || !*got_frame) break;
      if (frame.counts.size() != (*suit)->arrays().at(array).shape.taxel_count()) std::abort();
      if (frames % 2 == 0) middle = frame.time;
    }
    (*suit)->seek(middle);
  }
}

/// A recovery of nothing has failed; every other error is of the input.
void check_recovery_error(dermis::Error error) {
  if (error.kind == dermis::ErrorKind::failed) error.kind = dermis::ErrorKind::bad_input;
  dermis::fuzz::check_error(error);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto recording = dermis::bytes::recordings::RecordingReader::open(stream_of(data, size), "fuzz");
  if (!recording) dermis::fuzz::check_error(recording.error());
  dermis::RawFrame frame;
  while (recording) {
    const dermis::Result<bool> got_frame = (*recording)->next(frame);
    if (!got_frame) dermis::fuzz::check_error(got_frame.error());
    if (!got_frame || !*got_frame) break;
    if (frame.counts.size() != (*recording)->shape()->taxel_count()) std::abort();
  }
  read_suit(data, size);
  const auto recovery = dermis::bytes::recordings::recover_recording(stream_of(data, size), "fuzz", "/dev/null");
  if (!recovery) check_recovery_error(recovery.error());
  return 0;
}
