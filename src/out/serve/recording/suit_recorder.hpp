// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <thread>
#include <vector>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// The name of a recording, so that nothing is overwritten. The first has the wanted name. Later ones, and all where
/// none is wanted or it exists, have the time in it: "rec-20261122-101500-123.mcap".
[[nodiscard]] std::string recording_name(const std::string& wanted, bool is_first,
                                         std::chrono::system_clock::time_point now);

/// Records every frame of all arrays as the device sent it, from begin() to stop(), and events. No array waits for the
/// disk. While a disk stalls, frames wait in 64 MB of memory; later ones are left out and counted. Thread-safe.
class SuitRecorder {
 public:
  using Arrays = std::function<std::vector<bytes::recordings::RecordedArray>()>;
  using Failed = std::function<void(const std::string& why)>;
  using Written = std::function<void(std::uint64_t frames)>;

  /// `wanted`: the path of the first recording, or empty. `arrays` gives begin() the recorded arrays. The thread that
  /// closes the file calls `failed` with the reason why a recording ended, and `written` with the frames of a complete
  /// one.
  SuitRecorder(std::string wanted, Arrays arrays, Failed failed, Written written = {});
  SuitRecorder(const SuitRecorder&) = delete;
  SuitRecorder& operator=(const SuitRecorder&) = delete;
  /// Does the same as end().
  ~SuitRecorder();

  /// Fails where the file cannot be made, or a recording goes on. `path`: of a file that is not there yet; empty: the
  /// recorder names it.
  [[nodiscard]] Status begin(std::string path = {});
  /// Takes no more frames; the file is closed in the background.
  void stop();
  /// stop(), and waits for it; the outcome of the recording. Done where there is none.
  [[nodiscard]] Status end();
  /// Begins again after a recording that could not be written, where its disk has room now. False: it does not. The
  /// frames between are missed().
  [[nodiscard]] bool resume();

  /// Takes part in the recording that goes on, if there is one. Each array is written by one thread.
  void write(std::size_t array, const RawFrame& raw);
  void write(const bytes::recordings::RecordedEvent& event);

  [[nodiscard]] bool recording() const noexcept { return recording_.load(); }
  /// Path of the present or the last recording.
  [[nodiscard]] std::string path() const;
  [[nodiscard]] std::uint64_t frames() const noexcept { return frames_.load(); }
  /// Frames and events, but those of frames, that are missing in the present or the last recording, because its disk
  /// was too slow.
  [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_.load(); }
  /// Frames that are in no recording since begin(): they came before resume(), or waited when the disk was full.
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_.load(); }

 private:
  /// `write` counts what the writer took. Ends a recording that cannot be written.
  template <typename Write>
  void write_with(const Write& write);
  enum class Counts : std::uint8_t { anew, go_on };
  [[nodiscard]] Status begin(std::string path, Counts counts);
  void release();
  void close(bytes::recordings::SuitRecordingWriter& writer);
  void await_closing();

  const std::string wanted_;
  const Arrays arrays_;
  const Failed failed_;
  const Written written_;
  std::mutex switch_mutex_;  // One begin() or end() at a time.
  std::atomic<bool> recording_{false};
  std::atomic<std::uint64_t> frames_{0};
  std::atomic<std::uint64_t> left_out_{0};
  std::atomic<bool> is_wanted_{false};  // From begin() to stop(), though it may have failed;
  std::atomic<bool> is_broken_{false};  // then its file is closed.
  std::atomic<std::uint64_t> missed_{0};
  Status outcome_ = Done{};  // Of closing_, once it has ended.

  mutable std::shared_mutex writer_mutex_;  // Guards the members below; shared by those who write.
  std::unique_ptr<bytes::recordings::SuitRecordingWriter> writer_;
  std::thread closing_;
  std::string path_;
};

}  // namespace dermis::out::serve
