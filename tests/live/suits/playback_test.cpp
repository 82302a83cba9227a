// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/suits/playback.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <thread>

#include "support/random_frames.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::live::suits {
namespace {

using bytes::recordings::RecordedArray;
using support::TemporaryFolder;

constexpr Nanos kStart{1'760'000'000'000'000'000};
constexpr Nanos kInterval{10'000'000};

std::vector<RecordedArray> arrays() {
  return {{.name = "chest", .shape = {4, 4}}, {.name = "back", .shape = {3, 5}}};
}

/// Both arrays a frame each 10 ms, 'back' from `back_from` on.
void record(const std::string& path, std::size_t frames, std::size_t back_from = 0) {
  const auto writer = bytes::recordings::SuitRecordingWriter::create(path, arrays());
  ASSERT_TRUE(writer);
  Random random(1);
  for (std::size_t i = 0; i < frames; ++i) {
    for (const std::size_t array : {std::size_t{0}, std::size_t{1}}) {
      if (array == 1 && i < back_from) continue;
      const std::size_t taxels = arrays()[array].shape.taxel_count();
      RawFrame frame = support::random_frame(random, taxels, support::RandomCounts::whole);
      frame.time = kStart + static_cast<std::int64_t>(i) * kInterval;
      frame.counts[0] = static_cast<float>(i);
      ASSERT_TRUE((*writer)->write(array, frame));
    }
  }
  ASSERT_TRUE((*writer)->commit());
}

std::unique_ptr<Playback> opened(const std::string& path) {
  Result<std::unique_ptr<Playback>> playback = Playback::open(path);
  EXPECT_TRUE(playback) << playback.error().message;
  return *std::move(playback);
}

/// The number of the next frame.
std::size_t next_number(FrameSource& source) {
  RawFrame frame;
  const Result<bool> more = source.next(frame);
  EXPECT_TRUE(more) << more.error().message;
  EXPECT_TRUE(more && *more);
  return more && *more ? static_cast<std::size_t>(frame.counts[0]) : std::numeric_limits<std::size_t>::max();
}

TEST(Playback, both_arrays_give_all_frames_in_order_on_one_clock) {
  const TemporaryFolder folder;
  record(folder.file("rec.mcap"), 100);
  const auto playback = opened(folder.file("rec.mcap"));
  ASSERT_EQ(playback->arrays().size(), 2U);
  EXPECT_EQ(playback->start(), kStart);
  EXPECT_EQ(playback->end(), kStart + 99 * kInterval);
  const std::vector<std::unique_ptr<FrameSource>> sources = [&] {
    std::vector<std::unique_ptr<FrameSource>> made;
    for (std::size_t i = 0; i < 2; ++i) made.push_back(playback->source(i));
    return made;
  }();
  EXPECT_TRUE(sources.front()->is_live());
  playback->control({.speed = 10.0});
  {
    std::vector<std::jthread> threads;
    for (const auto& source : sources) {
      threads.emplace_back([&source] {
        for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(next_number(*source), i);
      });
    }
  }
  EXPECT_EQ(sources[0]->statistics().frames, 100U);
  EXPECT_EQ(sources[1]->shape(), (FrameShape{3, 5}));
  while (playback->status().state != PlaybackStatus::State::ended) std::this_thread::yield();
  EXPECT_EQ(playback->status().now, playback->end());
  EXPECT_EQ(playback->control({.play = true}).state, PlaybackStatus::State::playing) << "from the beginning again";
  EXPECT_EQ(next_number(*sources[0]), 0U);
}

TEST(Playback, begins_paused_with_the_first_frames_and_shows_where_it_is_put) {
  const TemporaryFolder folder;
  record(folder.file("rec.mcap"), 100);
  const auto playback = opened(folder.file("rec.mcap"));
  const auto chest = playback->source(0);
  const auto back = playback->source(1);
  EXPECT_EQ(next_number(*chest), 0U);
  EXPECT_EQ(next_number(*back), 0U);
  EXPECT_EQ(playback->status().state, PlaybackStatus::State::paused);
  for (const std::int64_t number : {70, 20, 99, 0}) {
    const Nanos time = kStart + number * kInterval - Nanos(number == 0 ? 0 : 1);
    const PlaybackStatus status = playback->control({.play = false, .seek = time});
    EXPECT_EQ(status.state, PlaybackStatus::State::paused);
    EXPECT_EQ(status.now, time);
    EXPECT_EQ(next_number(*back), static_cast<std::size_t>(number));
    EXPECT_EQ(next_number(*chest), static_cast<std::size_t>(number));
  }
  EXPECT_EQ(playback->control({.play = false, .seek = kStart - std::chrono::hours(1)}).now, kStart);
  EXPECT_EQ(playback->control({.play = false, .seek = Nanos::max()}).now, playback->end());
}

TEST(Playback, shows_the_last_frame_again_to_who_has_not_seen_it) {
  const TemporaryFolder folder;
  record(folder.file("rec.mcap"), 10);
  const auto playback = opened(folder.file("rec.mcap"));
  const auto chest = playback->source(0);
  const auto back = playback->source(1);
  playback->show_again();
  for (const auto* source : {&chest, &back}) EXPECT_EQ(next_number(**source), 0U) << "once, at the beginning";
  playback->control({.play = false, .seek = kStart + 5 * kInterval});
  for (int time = 0; time < 3; ++time) {
    EXPECT_EQ(next_number(*chest), 5U) << time;
    EXPECT_EQ(next_number(*back), 5U) << time;
    playback->show_again();
  }
  EXPECT_EQ(playback->status().now, kStart + 5 * kInterval);
  EXPECT_EQ(playback->status().state, PlaybackStatus::State::paused);
}

TEST(Playback, stop_ends_sources_that_wait) {
  const TemporaryFolder folder;
  record(folder.file("rec.mcap"), 10);
  const auto playback = opened(folder.file("rec.mcap"));
  const auto chest = playback->source(0);
  EXPECT_EQ(next_number(*chest), 0U);
  std::jthread waiting([&] {
    RawFrame frame;
    const Result<bool> more = chest->next(frame);
    EXPECT_TRUE(more);
    EXPECT_FALSE(more && *more);
  });
  playback->stop();
}

TEST(Playback, a_waiting_source_goes_on_when_it_is_to_play) {
  const TemporaryFolder folder;
  record(folder.file("rec.mcap"), 10);
  const auto playback = opened(folder.file("rec.mcap"));
  const auto chest = playback->source(0);
  EXPECT_EQ(next_number(*chest), 0U);
  std::jthread waiting([&] {
    EXPECT_EQ(next_number(*chest), 1U);
    EXPECT_EQ(next_number(*chest), 2U);
  });
  playback->control({.play = true, .speed = 0.5});
}

TEST(Playback, a_slow_consumer_holds_the_clock_and_loses_nothing) {
  const TemporaryFolder folder;
  record(folder.file("rec.mcap"), 3000);
  const auto playback = opened(folder.file("rec.mcap"));
  const auto chest = playback->source(0);
  const auto back = playback->source(1);
  playback->control({.speed = 100.0});
  std::jthread fast([&] {
    for (std::size_t i = 0; i < 3000; ++i) EXPECT_EQ(next_number(*back), i);
  });
  for (std::size_t i = 0; i < 3000; ++i) {
    ASSERT_EQ(next_number(*chest), i);
    if (i % 500 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
}

TEST(Playback, an_array_that_comes_late_or_that_nobody_takes_holds_nothing_up) {
  const TemporaryFolder folder;
  record(folder.file("rec.mcap"), 2500, 2400);
  for (const bool takes_back : {true, false}) {
    const auto playback = opened(folder.file("rec.mcap"));
    const auto chest = playback->source(0);
    std::jthread taker;
    if (takes_back) {
      taker = std::jthread([back = playback->source(1)] { EXPECT_EQ(next_number(*back), 2400U); });
    }
    playback->control({.speed = 100.0});
    for (std::size_t i = 0; i < 2500; ++i) ASSERT_EQ(next_number(*chest), i);
  }
}

TEST(Playback, one_array_of_a_recording_is_chosen_by_its_name) {
  const TemporaryFolder folder;
  record(folder.file("rec.mcap"), 10);
  const auto playback = opened(folder.file("rec.mcap") + "#back");
  ASSERT_EQ(playback->arrays().size(), 1U);
  EXPECT_EQ(playback->arrays()[0].name, "back");
  const auto back = playback->source(0);
  EXPECT_EQ(next_number(*back), 0U);
  EXPECT_EQ(back->shape(), (FrameShape{3, 5}));
  const auto wrong = Playback::open(folder.file("rec.mcap") + "#front");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("has no array 'front'"), std::string::npos) << wrong.error().message;
}

TEST(Playback, of_no_frame_is_refused) {
  const TemporaryFolder folder;
  record(folder.file("rec.mcap"), 0);
  const auto playback = Playback::open(folder.file("rec.mcap"));
  ASSERT_FALSE(playback);
  EXPECT_EQ(playback.error().kind, ErrorKind::bad_input);
}

/// Where it begins: records of MCAP have an opcode and the length of what follows.
std::ptrdiff_t second_chunk(const std::string& bytes) {
  constexpr std::size_t kMagic = 8;
  constexpr std::size_t kHead = 9;
  constexpr char kChunk = 6;
  int chunks = 0;
  std::size_t place = kMagic;
  while (place + kHead < bytes.size()) {
    if (bytes[place] == kChunk && ++chunks == 2) return static_cast<std::ptrdiff_t>(place + kHead);
    std::uint64_t length = 0;
    std::memcpy(&length, &bytes[place + 1], sizeof length);
    place += kHead + length;
  }
  ADD_FAILURE() << "the recording has " << chunks << " chunks";
  return 0;
}

TEST(Playback, a_damaged_recording_gives_its_error_to_all_sources) {
  const TemporaryFolder folder;
  record(folder.file("rec.mcap"), 35'000);  // two chunks; more where writing is slow
  std::string bytes = support::read_bytes(folder.file("rec.mcap"));
  std::fill_n(bytes.begin() + second_chunk(bytes) + 100, 2000, 'x');
  support::write_bytes(folder.file("rec.mcap"), bytes);
  const auto playback = opened(folder.file("rec.mcap"));
  playback->control({.speed = 10'000.0});
  std::vector<std::jthread> threads;
  for (const std::size_t array : {std::size_t{0}, std::size_t{1}}) {
    threads.emplace_back([source = playback->source(array)] {
      RawFrame frame;
      Result<bool> more = true;
      while (more && *more) more = source->next(frame);
      EXPECT_FALSE(more);
    });
  }
}

}  // namespace
}  // namespace dermis::live::suits
