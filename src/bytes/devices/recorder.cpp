// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/recorder.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

namespace dermis::bytes::devices {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kTick{100};
constexpr std::chrono::milliseconds kGather{10};
constexpr std::chrono::milliseconds kProgressPeriod{500};
constexpr std::chrono::milliseconds kGrace{200};  // a source that gives frames ends by their times
constexpr std::size_t kMaxQueueBytes = std::size_t{128} << 20U;
constexpr std::size_t kLeastQueueFrames = 4;

std::size_t queue_frames(const FrameShape& shape, std::size_t wanted) {
  const std::size_t fitting = kMaxQueueBytes / (shape.taxel_count() * sizeof(float) + 1);
  return std::max(std::min(wanted, fitting), kLeastQueueFrames);
}

/// Writes the frames of a queue into a sink, on a thread of its own.
class Writer {
 public:
  Writer(std::unique_ptr<FrameSink> sink, const FrameShape& shape, const RecorderOptions& options)
      : options_(options),
        sink_(std::move(sink)),
        queue_(queue_frames(shape, options.queue_frames), Overflow::wait),
        thread_([this] { write_all(); }) {}
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { join(); }

  /// False where the sink has failed.
  bool push(RawFrame& frame) { return queue_.push(frame); }

  void set_source_statistics(const SourceStatistics& source) {
    const std::lock_guard lock(mutex_);
    source_ = source;
  }

  /// The same, where a tick has passed since.
  void tell_now_and_then(const FrameSource& source) {
    const Clock::time_point now = Clock::now();
    if (now < next_told_) return;
    set_source_statistics(source.statistics());
    next_told_ = now + kTick;
  }

  /// Writes what is left and commits, if there is anything. The first error of the sink.
  Status finish() {
    join();
    if (frames_ == 0) return status_;
    const Status committed = sink_->commit();
    return status_ ? committed : status_;
  }

  [[nodiscard]] RecorderProgress progress() const {
    const std::lock_guard lock(mutex_);
    return {frames_, source_, queue_.statistics()};
  }

 private:
  void join() {
    queue_.close();
    if (thread_.joinable()) thread_.join();
  }

  void write_all() {
    Clock::time_point next_progress = Clock::now() + kProgressPeriod;
    RawFrame frame;
    for (;;) {
      const FrameQueue::Pop popped = queue_.pop(frame, kTick);
      if (popped == FrameQueue::Pop::end) return;
      if (popped == FrameQueue::Pop::frame && !write(frame)) return queue_.leave();
      // Waking up costs as much as writing a frame, so some are gathered first.
      if (queue_.statistics().depth == 0) std::this_thread::sleep_for(kGather);
      const Clock::time_point now = Clock::now();
      if (now < next_progress) continue;
      next_progress = now + kProgressPeriod;
      report();
    }
  }

  bool write(const RawFrame& frame) {
    status_ = sink_->write(frame);
    if (!status_) return false;
    const std::lock_guard lock(mutex_);
    ++frames_;
    return true;
  }

  void report() {
    if (!options_.progress) return;
    RecorderProgress now = progress();
    if (now.frames == reported_frames_) now.source.rate_hz = 0.0;
    reported_frames_ = now.frames;
    options_.progress(now);
  }

  const RecorderOptions& options_;
  std::unique_ptr<FrameSink> sink_;
  FrameQueue queue_;
  mutable std::mutex mutex_;
  std::uint64_t frames_ = 0;
  SourceStatistics source_;
  Clock::time_point next_told_{};
  std::uint64_t reported_frames_ = 0;
  Status status_ = Done{};
  std::thread thread_;
};

/// Sets the stop flag where the duration has passed while the source waits for its device.
class Deadline {
 public:
  explicit Deadline(const RecorderOptions& options) : options_(options) {
    if (options.duration && options.stop != nullptr)
      thread_ = std::jthread([this](const std::stop_token& end) { watch(end); });
  }

  /// The duration counts from here.
  void begin_anew() { begin_ = Clock::now(); }
  void source_waits(bool waits) { waiting_since_ = waits ? Clock::now() : kNever; }

 private:
  void watch(const std::stop_token& end) {
    while (!end.stop_requested()) {
      const Clock::time_point now = Clock::now();
      const bool is_silent = now - kGrace > waiting_since_.load();
      if (is_silent && now > begin_.load() + *options_.duration) return options_.stop->store(true);
      std::this_thread::sleep_for(kTick / 4);
    }
  }

  static constexpr Clock::time_point kNever = Clock::time_point::max();
  const RecorderOptions& options_;
  std::atomic<Clock::time_point> begin_ = Clock::now();
  std::atomic<Clock::time_point> waiting_since_ = kNever;
  std::jthread thread_;
};

/// From `first` to `time`; a file may say anything: beyond 292 years it wraps.
Nanos time_between(Nanos first, Nanos time) {
  const std::uint64_t difference = static_cast<std::uint64_t>(time.count()) - static_cast<std::uint64_t>(first.count());
  return Nanos(static_cast<std::int64_t>(difference));
}

Result<std::unique_ptr<Writer>> open_writer(const OpenSink& open_sink, const FrameShape& shape,
                                            const RecorderOptions& options) {
  Result<std::unique_ptr<FrameSink>> sink = open_sink(shape);
  if (!sink) return sink.error();
  return std::make_unique<Writer>(*std::move(sink), shape, options);
}

bool is_asked_to_stop(const RecorderOptions& options) {
  return !options.source_stops && options.stop != nullptr && options.stop->load();
}

}  // namespace

Status record(FrameSource& source, const OpenSink& open_sink, const RecorderOptions& options, RecorderProgress& last) {
  last = {};
  std::unique_ptr<Writer> writer;
  const auto open = [&](const FrameShape& shape) -> Status {
    Result<std::unique_ptr<Writer>> opened = open_writer(open_sink, shape, options);
    if (!opened) return opened.error();
    writer = *std::move(opened);
    return Done{};
  };
  if (const std::optional<FrameShape> shape = source.shape()) {
    if (Status opened = open(*shape); !opened) return opened;
  }

  Status status = Done{};
  Deadline deadline(options);
  RawFrame frame;
  std::optional<Nanos> first_time;
  for (std::uint64_t frames = 0; !options.frames || frames < *options.frames; ++frames) {
    if (is_asked_to_stop(options)) break;
    deadline.source_waits(true);
    const Result<bool> more = source.next(frame);
    deadline.source_waits(false);
    if (!more) status = more.error();
    if (!more || !*more) break;
    if (!first_time) deadline.begin_anew();
    if (!first_time) first_time = frame.time;
    if (options.duration && time_between(*first_time, frame.time) >= *options.duration) break;
    if (!writer) {
      if (Status opened = open(*source.shape()); !opened) return opened;
    }
    if (!writer->push(frame)) break;
    writer->tell_now_and_then(source);
  }
  last.source = source.statistics();
  if (!writer) return status;
  writer->set_source_statistics(last.source);
  const Status finished = writer->finish();
  last = writer->progress();
  return status ? finished : status;
}

}  // namespace dermis::bytes::devices
