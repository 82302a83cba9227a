// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/suit_recorder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <thread>
#include <vector>

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "support/full_disk.hpp"
#include "support/random_frames.hpp"
#include "support/stalled_disk.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

using support::TemporaryFolder;

constexpr FrameShape kShape{2, 3};

std::vector<bytes::recordings::RecordedArray> arrays() {
  return {{.name = "chest", .shape = kShape}, {.name = "back", .shape = kShape}};
}

void fail_on(const std::string& why) {
  ADD_FAILURE() << why;
}

RawFrame frame(std::size_t number) {
  RawFrame frame;
  frame.time = Nanos(static_cast<std::int64_t>(number + 1) * 1'000'000);
  frame.counts.assign(kShape.taxel_count(), static_cast<float>(number));
  return frame;
}

/// The numbers of the frames of each array, as the file has them.
std::map<std::size_t, std::vector<std::size_t>> recorded(const std::string& path) {
  const auto reader = bytes::recordings::SuitRecordingReader::open(path);
  EXPECT_TRUE(reader) << reader.error().message;
  EXPECT_TRUE((*reader)->complete());
  EXPECT_EQ((*reader)->arrays().size(), 2U);
  std::map<std::size_t, std::vector<std::size_t>> numbers;
  std::size_t array = 0;
  RawFrame next;
  for (auto more = (*reader)->next(array, next); more && *more; more = (*reader)->next(array, next)) {
    numbers[array].push_back(static_cast<std::size_t>(next.counts[0]));
  }
  return numbers;
}

TEST(RecordingName, is_the_wanted_one_first_and_then_has_the_time_in_it) {
  const std::chrono::system_clock::time_point now(std::chrono::milliseconds(1'763'806'500'123));
  EXPECT_EQ(recording_name("runs/day.mcap", true, now), "runs/day.mcap");
  EXPECT_EQ(recording_name("runs/day.mcap", false, now), "runs/day-20251122-101500-123.mcap");
  EXPECT_EQ(recording_name("", true, now), "dermis-20251122-101500-123.mcap");
}

TEST(RecordingName, has_the_time_in_it_where_the_wanted_one_exists) {
  const TemporaryFolder folder;
  const std::string wanted = folder.file("day.mcap");
  std::ofstream(wanted) << "an earlier session";
  const std::chrono::system_clock::time_point now(std::chrono::milliseconds(1'763'806'500'123));
  EXPECT_EQ(recording_name(wanted, true, now), folder.file("day-20251122-101500-123.mcap"));
}

TEST(SuitRecorder, keeps_every_frame_of_arrays_that_write_at_once) {
  constexpr std::size_t kFrames = 5000;
  const TemporaryFolder folder;
  SuitRecorder recorder(folder.file("rec.mcap"), arrays, fail_on);
  ASSERT_TRUE(recorder.begin());
  EXPECT_TRUE(recorder.recording());
  const auto write = [&](std::size_t array) {
    for (std::size_t number = 0; number < kFrames; ++number) recorder.write(array, frame(number));
  };
  std::thread chest(write, 0);
  std::thread back(write, 1);
  chest.join();
  back.join();
  EXPECT_EQ(recorder.frames(), 2 * kFrames);
  ASSERT_TRUE(recorder.end());
  EXPECT_FALSE(recorder.recording());
  EXPECT_EQ(recorder.path(), folder.file("rec.mcap"));
  const auto numbers = recorded(folder.file("rec.mcap"));
  for (const std::size_t array : {0U, 1U}) {
    ASSERT_EQ(numbers.at(array).size(), kFrames);
    for (std::size_t k = 0; k < kFrames; ++k) ASSERT_EQ(numbers.at(array)[k], k);
  }
}

TEST(SuitRecorder, tells_how_many_frames_a_complete_recording_has) {
  const TemporaryFolder folder;
  std::uint64_t told = 0;
  SuitRecorder recorder(folder.file("rec.mcap"), arrays, fail_on, [&](std::uint64_t frames) { told = frames; });
  ASSERT_TRUE(recorder.begin());
  for (std::size_t number = 0; number < 7; ++number) recorder.write(0, frame(number));
  EXPECT_EQ(told, 0U);
  ASSERT_TRUE(recorder.end());
  EXPECT_EQ(told, 7U);
}

TEST(SuitRecorder, takes_no_frame_before_the_beginning_and_none_after_the_stop) {
  const TemporaryFolder folder;
  SuitRecorder recorder(folder.file("rec.mcap"), arrays, fail_on);
  recorder.write(0, frame(0));
  ASSERT_TRUE(recorder.begin());
  recorder.write(0, frame(1));
  recorder.stop();
  EXPECT_FALSE(recorder.recording());
  recorder.write(0, frame(2));
  ASSERT_TRUE(recorder.end());
  EXPECT_EQ(recorder.frames(), 1U);
  EXPECT_EQ(recorded(folder.file("rec.mcap")).at(0), (std::vector<std::size_t>{1}));
}

TEST(SuitRecorder, a_second_recording_leaves_the_first_as_it_is) {
  const TemporaryFolder folder;
  SuitRecorder recorder(folder.file("rec.mcap"), arrays, fail_on);
  ASSERT_TRUE(recorder.begin());
  recorder.write(0, frame(7));
  recorder.stop();
  ASSERT_TRUE(recorder.begin()) << "while the first may still be closed";
  EXPECT_EQ(recorder.frames(), 0U);
  recorder.write(0, frame(8));
  ASSERT_TRUE(recorder.end());
  EXPECT_NE(recorder.path(), folder.file("rec.mcap"));
  EXPECT_EQ(recorded(folder.file("rec.mcap")).at(0), (std::vector<std::size_t>{7}));
  EXPECT_EQ(recorded(recorder.path()).at(0), (std::vector<std::size_t>{8}));
}

TEST(SuitRecorder, refuses_to_begin_while_a_recording_goes_on) {
  const TemporaryFolder folder;
  SuitRecorder recorder(folder.file("rec.mcap"), arrays, fail_on);
  ASSERT_TRUE(recorder.begin());
  const Status again = recorder.begin();
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().message, "a recording goes on: " + folder.file("rec.mcap"));
  EXPECT_TRUE(recorder.recording());
}

TEST(SuitRecorder, says_where_it_cannot_begin_and_may_begin_later) {
  const TemporaryFolder folder;
  SuitRecorder recorder(folder.file("none/rec.mcap"), arrays, fail_on);
  const Status begun = recorder.begin();
  ASSERT_FALSE(begun);
  EXPECT_NE(begun.error().message.find("none/rec.mcap"), std::string::npos) << begun.error().message;
  EXPECT_FALSE(recorder.recording());
  EXPECT_EQ(recorder.path(), "");
  EXPECT_TRUE(recorder.end()) << "there was none";
  std::filesystem::create_directory(folder.file("none"));
  ASSERT_TRUE(recorder.begin());
  EXPECT_EQ(recorder.path(), folder.file("none/rec.mcap"));
}

TEST(SuitRecorder, waits_for_no_disk_that_stands_still_and_counts_what_it_has_no_room_for) {
  constexpr FrameShape kLarge{64, 64};
  const TemporaryFolder folder;
  support::StalledDisk disk(folder.file("rec.mcap"));
  const auto large = [&] { return std::vector<bytes::recordings::RecordedArray>{{.name = "chest", .shape = kLarge}}; };
  SuitRecorder recorder(folder.file("rec.mcap"), large, fail_on);
  ASSERT_TRUE(recorder.begin());
  Random random(1);
  std::uint64_t written = 0;
  const auto write = [&] {
    RawFrame noise = support::random_frame(random, kLarge.taxel_count(), support::RandomCounts::whole);
    noise.time = Nanos(static_cast<std::int64_t>(++written) * 1'000'000);
    noise.acquisition = {};
    recorder.write(0, noise);
  };
  while (recorder.left_out() < 10) write();
  const std::uint64_t before = recorder.frames();
  EXPECT_GT(before, 1000U) << "that wait for the disk";
  recorder.write({"/threat", bytes::ros_messages::threat_type(), {}, std::vector<std::uint8_t>(100)});
  EXPECT_EQ(recorder.left_out(), 10U) << "events have room of their own";

  disk.flow_into(folder.file("flown.mcap"));
  while (recorder.frames() == before) write();
  const std::uint64_t left_out = recorder.left_out();
  EXPECT_EQ(recorder.frames() + left_out, written);
  ASSERT_TRUE(recorder.end());
  disk.await_end();

  const auto reader = bytes::recordings::SuitRecordingReader::open(folder.file("flown.mcap"));
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_TRUE((*reader)->complete());
  std::size_t array = 0;
  RawFrame frame;
  std::uint64_t frames = 0;
  std::uint64_t lost = 0;
  for (auto more = (*reader)->next(array, frame); more && *more; more = (*reader)->next(array, frame)) {
    ++frames;
    lost += frame.acquisition.lost_before;
  }
  EXPECT_EQ(frames, before + 1);
  EXPECT_EQ(lost, left_out) << "the frames after gaps tell them";
}

TEST(SuitRecorder, tells_once_that_the_disk_is_full) {
  const TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  const auto record = [&]() -> Status {
    std::vector<std::string> told;
    SuitRecorder recorder(path, arrays, [&](const std::string& why) { told.push_back(why); });
    if (Status begun = recorder.begin(); !begun) return begun;
    Random random(1);
    RawFrame noise;
    for (std::size_t number = 0; recorder.recording(); ++number) {
      noise = support::random_frame(random, kShape.taxel_count(), support::RandomCounts::whole);
      noise.time = Nanos(static_cast<std::int64_t>(number + 1) * 1'000'000);
      recorder.write(0, noise);
    }
    const Status ended = recorder.end();
    const bool is_told = !ended && told == std::vector<std::string>{ended.error().message};
    return is_told ? ended : failed("not what was told");
  };
  EXPECT_EQ(support::write_within(200'000, path, record), 1);
}

/// Writes frames of noise from `number` on until the recording ends by itself.
std::size_t fill(SuitRecorder& recorder, std::size_t number) {
  const support::SmallDisk disk(200'000);
  Random random(1);
  for (; recorder.recording(); ++number) {
    RawFrame noise = support::random_frame(random, kShape.taxel_count(), support::RandomCounts::whole);
    noise.time = Nanos(static_cast<std::int64_t>(number + 1) * 1'000'000);
    recorder.write(0, noise);
    std::this_thread::sleep_for(std::chrono::microseconds(100));  // so that the file has some chunks
  }
  return number;
}

/// The recorder closes a file in the background.
bool resumes(SuitRecorder& recorder) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < end) {
    if (recorder.resume()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

TEST(SuitRecorder, goes_on_in_another_file_when_a_full_disk_has_room_and_counts_the_frames_between) {
  const TemporaryFolder folder;
  std::vector<std::string> told;
  const std::string first = folder.file("rec.mcap");
  SuitRecorder recorder(first, arrays, [&](const std::string& why) { told.push_back(why); });
  ASSERT_TRUE(recorder.begin());
  std::size_t number = fill(recorder, 0);
  for (std::size_t k = 0; k < 5; ++k) recorder.write(0, frame(number++));
  ASSERT_TRUE(resumes(recorder));
  EXPECT_TRUE(recorder.recording());
  EXPECT_EQ(told.size(), 1U);
  const auto kept = std::filesystem::exists(first) ? recorded(first).at(0).size() : 0;
  EXPECT_EQ(kept + recorder.missed(), number);
  EXPECT_FALSE(recorder.resume()) << "it goes on already";
  recorder.write(0, frame(number));
  const std::string path = recorder.path();
  ASSERT_TRUE(recorder.end());
  EXPECT_NE(path, first);
  EXPECT_EQ(recorded(path).at(0), (std::vector<std::size_t>{number}));
}

TEST(SuitRecorder, does_not_go_on_after_a_full_disk_where_somebody_has_switched_it_off) {
  const TemporaryFolder folder;
  SuitRecorder recorder(folder.file("rec.mcap"), arrays, [](const std::string&) {});
  ASSERT_TRUE(recorder.begin());
  const std::size_t number = fill(recorder, 0);
  ASSERT_FALSE(recorder.end());
  recorder.write(0, frame(number));
  EXPECT_FALSE(recorder.resume());
  EXPECT_FALSE(recorder.recording());
}

}  // namespace
}  // namespace dermis::out::serve
