// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/recorder.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

namespace dermis::bytes::devices {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

constexpr FrameShape kShape{2, 3};

/// Frames at 1 kHz of their own time, as fast as they are read; then an end, an error or silence.
class Frames final : public FrameSource {
 public:
  enum class After { end, error, silence };
  Frames(std::int64_t count, After after, const std::atomic<bool>* stop = nullptr)
      : count_(count), after_(after), stop_(stop) {}

  Result<bool> next(RawFrame& frame) override {
    if (given_ == count_) {
      while (after_ == After::silence && !stop_->load()) std::this_thread::sleep_for(1ms);
      if (after_ == After::error) return failed("unplugged");
      return false;
    }
    frame.time = given_ * 1ms;
    frame.counts.assign(kShape.taxel_count(), static_cast<float>(given_));
    ++given_;
    return true;
  }
  [[nodiscard]] std::optional<FrameShape> shape() const override {
    if (shape_with_first_frame && given_ == 0) return std::nullopt;
    return kShape;
  }
  [[nodiscard]] SourceStatistics statistics() const override {
    SourceStatistics statistics;
    statistics.frames = static_cast<std::uint64_t>(given_);
    statistics.lost_frames = 3;
    return statistics;
  }
  bool shape_with_first_frame = false;

 private:
  std::int64_t count_;
  After after_;
  const std::atomic<bool>* stop_;
  std::int64_t given_ = 0;
};

/// What a sink was given; it outlives the sink.
struct Written {
  std::vector<std::int64_t> frames;  // [ms]
  int opened = 0;
  int committed = 0;
  std::int64_t fails_at = -1;
  Nanos slow{};
};

class Sink final : public FrameSink {
 public:
  explicit Sink(Written& written) : written_(written) {}
  Status write(const RawFrame& frame) override {
    if (written_.slow > Nanos{}) std::this_thread::sleep_for(written_.slow);
    if (frame.time / 1ms == written_.fails_at) return failed("disk full");
    EXPECT_EQ(frame.counts.size(), kShape.taxel_count());
    EXPECT_EQ(frame.counts[5], static_cast<float>(frame.time / 1ms));
    written_.frames.push_back(frame.time / 1ms);
    return Done{};
  }
  Status commit() override {
    ++written_.committed;
    return Done{};
  }

 private:
  Written& written_;
};

OpenSink sink_into(Written& written) {
  return [&written](const FrameShape& shape) -> Result<std::unique_ptr<FrameSink>> {
    EXPECT_EQ(shape, kShape);
    ++written.opened;
    return std::unique_ptr<FrameSink>(std::make_unique<Sink>(written));
  };
}

std::vector<std::int64_t> numbers(std::int64_t count) {
  std::vector<std::int64_t> all;
  for (std::int64_t number = 0; number < count; ++number) all.push_back(number);
  return all;
}

TEST(Recorder, writes_every_frame_in_order) {
  for (const bool late_shape : {false, true}) {
    Frames source(5000, Frames::After::end);
    source.shape_with_first_frame = late_shape;
    Written written;
    RecorderProgress last;
    ASSERT_TRUE(record(source, sink_into(written), {}, last));
    EXPECT_EQ(written.frames, numbers(5000));
    EXPECT_EQ(written.opened, 1);
    EXPECT_EQ(written.committed, 1);
    EXPECT_EQ(last.frames, 5000U);
    EXPECT_EQ(last.source.lost_frames, 3U);
  }
}

TEST(Recorder, stops_after_frames_and_after_a_duration) {
  Frames source(5000, Frames::After::end);
  Written written;
  RecorderProgress last;
  ASSERT_TRUE(record(source, sink_into(written), {.frames = 17}, last));
  EXPECT_EQ(written.frames, numbers(17));

  Frames other(5000, Frames::After::end);
  Written timed;
  ASSERT_TRUE(record(other, sink_into(timed), {.duration = 100ms}, last));
  EXPECT_EQ(timed.frames, numbers(100));
}

TEST(Recorder, a_duration_ends_though_the_device_is_silent) {
  std::atomic<bool> stop = false;
  Frames source(3, Frames::After::silence, &stop);
  Written written;
  RecorderProgress last;
  ASSERT_TRUE(record(source, sink_into(written), {.duration = 50ms, .stop = &stop}, last));
  EXPECT_EQ(written.frames, numbers(3));
  EXPECT_EQ(written.committed, 1);
}

TEST(Recorder, a_duration_ends_though_no_frame_ever_comes) {
  std::atomic<bool> stop = false;
  Frames source(0, Frames::After::silence, &stop);
  source.shape_with_first_frame = true;
  Written written;
  RecorderProgress last;
  ASSERT_TRUE(record(source, sink_into(written), {.duration = 50ms, .stop = &stop}, last));
  EXPECT_EQ(written.opened, 0);
}

TEST(Recorder, stops_by_the_flag) {
  std::atomic<bool> stop = false;
  Frames source(3, Frames::After::silence, &stop);
  Written written;
  RecorderProgress last;
  std::thread user([&] {
    std::this_thread::sleep_for(20ms);
    stop = true;
  });
  ASSERT_TRUE(record(source, sink_into(written), {.stop = &stop}, last));
  user.join();
  EXPECT_EQ(written.frames, numbers(3));
  EXPECT_EQ(written.committed, 1);
}

TEST(Recorder, waits_for_a_source_that_gives_what_it_has_before_it_stops) {
  for (const bool source_stops : {true, false}) {
    std::atomic<bool> stop = true;
    Frames source(30, Frames::After::silence, &stop);
    Written written;
    RecorderProgress last;
    ASSERT_TRUE(record(source, sink_into(written), {.stop = &stop, .source_stops = source_stops}, last));
    EXPECT_EQ(written.frames, numbers(source_stops ? 30 : 0));
  }
}

TEST(Recorder, keeps_what_came_before_the_device_failed) {
  Frames source(40, Frames::After::error);
  Written written;
  RecorderProgress last;
  const Status status = record(source, sink_into(written), {}, last);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message, "unplugged");
  EXPECT_EQ(written.frames, numbers(40));
  EXPECT_EQ(written.committed, 1);
  EXPECT_EQ(last.frames, 40U);
}

TEST(Recorder, keeps_what_was_written_before_the_disk_was_full) {
  Frames source(1'000'000, Frames::After::end);
  Written written;
  written.fails_at = 30;
  RecorderProgress last;
  const Status status = record(source, sink_into(written), {}, last);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message, "disk full");
  EXPECT_EQ(written.frames, numbers(30));
  EXPECT_EQ(written.committed, 1);
}

TEST(Recorder, tells_the_back_pressure_of_a_slow_disk) {
  Frames source(40, Frames::After::end);
  Written written;
  written.slow = 1ms;
  RecorderProgress last;
  ASSERT_TRUE(record(source, sink_into(written), {.queue_frames = 4}, last));
  EXPECT_EQ(written.frames, numbers(40));
  EXPECT_GT(last.queue.waits, 0U);
  EXPECT_GT(last.queue.longest_wait, Nanos{});
}

TEST(Recorder, a_sink_that_cannot_be_made_is_the_error) {
  Frames source(40, Frames::After::end);
  RecorderProgress last;
  const Status status = record(
      source, [](const FrameShape&) -> Result<std::unique_ptr<FrameSink>> { return failed("no such folder"); }, {},
      last);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message, "no such folder");
}

TEST(Recorder, a_source_without_frames_leaves_no_file) {
  for (const bool late_shape : {false, true}) {
    Frames source(0, Frames::After::end);
    source.shape_with_first_frame = late_shape;
    Written written;
    RecorderProgress last;
    EXPECT_TRUE(record(source, sink_into(written), {}, last));
    EXPECT_EQ(written.opened, late_shape ? 0 : 1);
    EXPECT_EQ(written.committed, 0);
  }
}

TEST(Recorder, reports_how_it_goes) {
  std::atomic<bool> stop = false;
  Frames source(10, Frames::After::silence, &stop);
  Written written;
  RecorderProgress last;
  std::uint64_t reported = 0;
  RecorderOptions options;
  options.stop = &stop;
  options.progress = [&](const RecorderProgress& progress) {
    reported = progress.frames;
    stop = true;
  };
  ASSERT_TRUE(record(source, sink_into(written), options, last));
  EXPECT_EQ(reported, 10U);
}

}  // namespace
}  // namespace dermis::bytes::devices
