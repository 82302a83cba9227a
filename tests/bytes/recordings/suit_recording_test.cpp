// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/suit_recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <thread>

#include "dermis/bytes/recordings/recording.hpp"
#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "support/mutations.hpp"
#include "support/random_frames.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr Nanos kStart{1'760'000'000'000'000'000};

struct Written {
  std::size_t array = 0;
  RawFrame frame;
};

std::vector<RecordedArray> three_arrays() {
  return {{.name = "chest", .shape = {3, 5}, .array_toml = "[array]\nname = \"chest\"\n", .model_hash = "fnv1a64:1"},
          {.name = "left-hand", .shape = {4, 4}, .model_hash = "fnv1a64:2"},
          {.name = "back", .shape = {16, 16}, .array_toml = "[array]\nname = \"back\"\n"}};
}

/// Frames of all arrays by turns of chance, a millisecond apart.
std::vector<Written> interleaved(const std::vector<RecordedArray>& arrays, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Written> all;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t array = random.below(arrays.size());
    all.push_back(
        {array, support::random_frame(random, arrays[array].shape.taxel_count(), support::RandomCounts::whole)});
    all.back().frame.time = kStart + Nanos(static_cast<std::int64_t>(i) * 1'000'000);
    all.back().frame.acquisition.lost_before = static_cast<std::uint32_t>(random.below(3));
  }
  return all;
}

void record(const std::string& path, const std::vector<RecordedArray>& arrays, const std::vector<Written>& all,
            const SuitRecordingOptions& options = {}) {
  const auto writer = SuitRecordingWriter::create(path, arrays, options);
  ASSERT_TRUE(writer) << writer.error().message;
  for (const Written& written : all) ASSERT_TRUE((*writer)->write(written.array, written.frame));
  const Status committed = (*writer)->commit();
  ASSERT_TRUE(committed) << committed.error().message;
}

std::vector<Written> read_suit(SuitRecordingReader& reader) {
  std::vector<Written> all;
  Written read;
  while (true) {
    const Result<bool> more = reader.next(read.array, read.frame);
    EXPECT_TRUE(more) << more.error().message;
    if (!more || !*more) return all;
    all.push_back(read);
  }
}

std::vector<Written> read_suit(const std::string& path) {
  const auto reader = SuitRecordingReader::open(path);
  EXPECT_TRUE(reader) << reader.error().message;
  return reader ? read_suit(**reader) : std::vector<Written>();
}

void expect_same(const std::vector<Written>& read, const std::vector<Written>& written) {
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    SCOPED_TRACE(i);
    ASSERT_EQ(read[i].array, written[i].array);
    support::expect_same_frame(read[i].frame, written[i].frame);
  }
}

std::vector<RawFrame> of_array(const std::vector<Written>& all, std::size_t array) {
  std::vector<RawFrame> frames;
  for (const Written& written : all) {
    if (written.array == array) frames.push_back(written.frame);
  }
  return frames;
}

/// Many chunks: each array has frames that fill one quickly.
std::vector<RecordedArray> large_arrays() {
  return {{.name = "a", .shape = {512, 512}}, {.name = "b", .shape = {512, 512}}};
}

TEST(SuitRecording, every_frame_of_every_array_reads_back_with_the_same_bits) {
  for (const McapCompression compression : {McapCompression::none, McapCompression::lz4, McapCompression::zstd}) {
    const support::TemporaryFolder folder;
    const std::vector<RecordedArray> arrays = three_arrays();
    const std::vector<Written> all = interleaved(arrays, 500, 1);
    record(folder.file("rec.mcap"), arrays, all, {.compression = compression});
    expect_same(read_suit(folder.file("rec.mcap")), all);
    for (std::size_t i = 0; i < arrays.size(); ++i) {
      const auto reader = RecordingReader::open(folder.file("rec.mcap"), arrays[i].name);
      ASSERT_TRUE(reader) << reader.error().message;
      EXPECT_EQ((*reader)->notes(), (FrameNotes{arrays[i].name, arrays[i].array_toml, arrays[i].model_hash}));
      EXPECT_EQ((*reader)->shape(), arrays[i].shape);
      support::expect_same_frames(**reader, of_array(all, i));
    }
    EXPECT_EQ(folder.file_count(), 1U);
  }
}

TEST(SuitRecording, temperatures_of_several_sensors_read_back_with_the_same_bits) {
  const support::TemporaryFolder folder;
  const std::vector<RecordedArray> arrays = three_arrays();
  std::vector<Written> all = interleaved(arrays, 200, 2);
  Random random(3);
  for (Written& written : all) {
    if (written.array == 1) continue;  // some arrays have one sensor
    for (std::size_t k = 0; k < 4; ++k) {
      written.frame.sensor_celsius.push_back(static_cast<float>(random.uniform(-10.0, 60.0)));
    }
  }
  record(folder.file("rec.mcap"), arrays, all);
  const std::vector<Written> read = read_suit(folder.file("rec.mcap"));
  ASSERT_EQ(read.size(), all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(read[k].frame.sensor_celsius, all[k].frame.sensor_celsius);
    EXPECT_EQ(read[k].frame.counts, all[k].frame.counts);
  }
}

TEST(SuitRecording, one_sensor_a_taxel_reads_back_from_an_array_of_more_than_1024) {
  const support::TemporaryFolder folder;
  const std::vector<RecordedArray> arrays{{.name = "chest", .shape = {33, 32}}};
  std::vector<Written> all = interleaved(arrays, 3, 4);
  for (Written& written : all) {
    for (std::size_t k = 0; k < arrays[0].shape.taxel_count(); ++k) {
      written.frame.sensor_celsius.push_back(20.0F + 0.01F * static_cast<float>(k));
    }
  }
  record(folder.file("rec.mcap"), arrays, all);
  expect_same(read_suit(folder.file("rec.mcap")), all);
}

TEST(SuitRecording, whole_temperatures_of_sensors_are_32FC1_too) {
  const support::TemporaryFolder folder;
  const std::vector<RecordedArray> arrays{{.name = "chest", .shape = {3, 5}}};
  std::vector<Written> all = interleaved(arrays, 1, 5);
  all[0].frame.sensor_celsius = {20.0F, 21.0F};
  record(folder.file("rec.mcap"), arrays, all);
  const auto mcap = McapReader::open(folder.file("rec.mcap"));
  ASSERT_TRUE(mcap) << mcap.error().message;
  McapMessage message;
  std::string image;
  for (Result<bool> more = (*mcap)->next(message); more && *more; more = (*mcap)->next(message)) {
    const bool is_of_sensors = (*mcap)->channels().at(message.channel).topic == "/chest/temperatures";
    if (is_of_sensors) image.assign(message.data.begin(), message.data.end());
  }
  EXPECT_NE(image.find("32FC1"), std::string::npos);
  expect_same(read_suit(folder.file("rec.mcap")), all);
}

TEST(SuitRecording, of_one_array_is_a_recording_as_recording_writer_makes_it) {
  const support::TemporaryFolder folder;
  const std::vector<RecordedArray> arrays{three_arrays().front()};
  const std::vector<Written> all = interleaved(arrays, 1, 2);
  record(folder.file("suit.mcap"), arrays, all);
  RecordingOptions options;
  options.name = arrays[0].name;
  options.array_toml = arrays[0].array_toml;
  options.model_hash = arrays[0].model_hash;
  const auto writer = RecordingWriter::create(folder.file("one.mcap"), arrays[0].shape, options);
  ASSERT_TRUE(writer);
  for (const Written& written : all) ASSERT_TRUE((*writer)->write(written.frame));
  ASSERT_TRUE((*writer)->commit());
  EXPECT_EQ(support::read_bytes(folder.file("suit.mcap")), support::read_bytes(folder.file("one.mcap")));
}

TEST(SuitRecording, each_array_has_a_thread_that_writes) {
  const support::TemporaryFolder folder;
  const std::vector<RecordedArray> arrays = three_arrays();
  const std::vector<Written> all = interleaved(arrays, 3000, 3);
  const auto writer = SuitRecordingWriter::create(folder.file("rec.mcap"), arrays);
  ASSERT_TRUE(writer);
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < arrays.size(); ++i) {
      threads.emplace_back([&, i] {
        for (const RawFrame& frame : of_array(all, i)) EXPECT_TRUE((*writer)->write(i, frame));
      });
    }
  }
  ASSERT_TRUE((*writer)->commit());
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    const auto reader = RecordingReader::open(folder.file("rec.mcap"), arrays[i].name);
    ASSERT_TRUE(reader);
    support::expect_same_frames(**reader, of_array(all, i));
  }
}

TEST(SuitRecording, an_array_that_comes_late_or_pauses_keeps_the_order_of_all) {
  const support::TemporaryFolder folder;
  const std::vector<RecordedArray> arrays = large_arrays();
  std::vector<Written> all = interleaved(arrays, 50, 4);
  Nanos late = kStart - std::chrono::seconds(10);
  for (Written& written : all) {
    if (written.array == 0) written.frame.time = late += Nanos(1'000'000);
  }
  record(folder.file("rec.mcap"), arrays, all, {.compression = McapCompression::none});
  expect_same(read_suit(folder.file("rec.mcap")), all);
}

TEST(SuitRecording, messages_of_no_frame_stand_beside_the_frames) {
  const support::TemporaryFolder folder;
  const std::vector<RecordedArray> arrays = three_arrays();
  const std::vector<Written> all = interleaved(arrays, 50, 9);
  const std::vector<std::uint8_t> event = {0, 1, 0, 0, 7};
  const auto writer = SuitRecordingWriter::create(folder.file("suit.mcap"), arrays);
  ASSERT_TRUE(writer);
  for (const Written& written : all) {
    ASSERT_TRUE(
        (*writer)->write({"/chest/recognition", ros_messages::classification_type(), written.frame.time, event}));
    ASSERT_TRUE((*writer)->write(written.array, written.frame));
  }
  ASSERT_TRUE((*writer)->commit());
  const auto suit = SuitRecordingReader::open(folder.file("suit.mcap"));
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_EQ((*suit)->arrays().size(), arrays.size());
  EXPECT_EQ(read_suit(**suit).size(), all.size());
  const auto mcap = McapReader::open(folder.file("suit.mcap"));
  ASSERT_TRUE(mcap);
  std::uint32_t events = 0;
  McapMessage message;
  for (auto more = (*mcap)->next(message); more && *more; more = (*mcap)->next(message)) {
    if ((*mcap)->channels().at(message.channel).topic != "/chest/recognition") continue;
    EXPECT_EQ(std::vector<std::uint8_t>(message.data.begin(), message.data.end()), event);
    EXPECT_EQ(message.sequence, events++);
  }
  EXPECT_EQ(events, all.size());
}

TEST(SuitRecording, log_times_of_each_array_rise) {
  const support::TemporaryFolder folder;
  const std::vector<RecordedArray> arrays = three_arrays();
  std::vector<Written> all = interleaved(arrays, 200, 5);
  for (Written& written : all) written.frame.time = Nanos(written.frame.acquisition.arrival_steady);  // any
  record(folder.file("rec.mcap"), arrays, all);
  const auto mcap = McapReader::open(folder.file("rec.mcap"));
  ASSERT_TRUE(mcap);
  std::map<std::uint16_t, std::uint64_t> last;
  McapMessage message;
  while (true) {
    const Result<bool> more = (*mcap)->next(message);
    ASSERT_TRUE(more);
    if (!*more) break;
    EXPECT_GE(message.log_time, last[message.channel]);
    last[message.channel] = message.log_time;
  }
  EXPECT_GE(last.size(), 6U);
}

TEST(SuitRecording, names_that_give_the_same_topics_are_refused) {
  const support::TemporaryFolder folder;
  std::vector<RecordedArray> arrays = three_arrays();
  arrays[2].name = "left_hand";
  const auto writer = SuitRecordingWriter::create(folder.file("rec.mcap"), arrays);
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().kind, ErrorKind::bad_input);
  EXPECT_NE(writer.error().message.find("'left-hand' and 'left_hand'"), std::string::npos) << writer.error().message;
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(SuitRecording, what_is_to_be_read_is_named) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  record(path, three_arrays(), interleaved(three_arrays(), 20, 6));
  const auto none = RecordingReader::open(path);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message,
            path + ": holds 3 arrays; name one, as '" + path + "#chest': 'chest', 'left-hand', 'back'");
  const auto wrong = RecordingReader::open(path, "chets");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message, path + ": has no array 'chets'; it has: 'chest', 'left-hand', 'back'");
}

TEST(SuitRecording, a_text_names_a_file_and_an_array_of_it) {
  const support::TemporaryFolder folder;
  const auto place = [&](const std::string& name) {
    const RecordingPlace found = recording_place(folder.file(name));
    return std::pair(found.path.substr(folder.file("").size()), found.array);
  };
  EXPECT_EQ(place("rec.mcap"), std::pair(std::string("rec.mcap"), std::string()));
  EXPECT_EQ(place("rec.mcap#chest"), std::pair(std::string("rec.mcap"), std::string("chest")));
  EXPECT_EQ(place("#1.mcap"), std::pair(std::string("#1.mcap"), std::string()));
  EXPECT_EQ(place("a#1.mcap#chest"), std::pair(std::string("a#1.mcap"), std::string("chest")));
  EXPECT_EQ(place("a.mcap#1.csv"), std::pair(std::string("a.mcap"), std::string("1.csv")));
  support::write_bytes(folder.file("a.mcap#1.csv"), "");
  EXPECT_EQ(place("a.mcap#1.csv"), std::pair(std::string("a.mcap#1.csv"), std::string()));
}

TEST(SuitRecording, information_is_said_at_once_and_by_reading_all) {
  const support::TemporaryFolder folder;
  const std::vector<RecordedArray> arrays = three_arrays();
  const std::vector<Written> all = interleaved(arrays, 200, 7);
  record(folder.file("rec.mcap"), arrays, all);
  const std::string bytes = support::read_bytes(folder.file("rec.mcap"));
  support::write_bytes(folder.file("cut.mcap"), bytes.substr(0, bytes.size() - 10));
  for (const auto& [name, complete] : {std::pair{"rec.mcap", true}, {"cut.mcap", false}}) {
    SCOPED_TRACE(name);
    const Result<RecordingInfo> info = recording_info(folder.file(name));
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_EQ(info->complete, complete);
    EXPECT_EQ(info->frames, 200U);
    EXPECT_DOUBLE_EQ(info->duration_s, 0.199);
    EXPECT_EQ(info->start_utc, kStart);
    ASSERT_EQ(info->arrays.size(), 3U);
    std::uint64_t lost_of_all = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint64_t lost = 0;
      for (const RawFrame& frame : of_array(all, i)) lost += frame.acquisition.lost_before;
      EXPECT_EQ(info->arrays[i].name, arrays[i].name);
      EXPECT_EQ(info->arrays[i].shape, arrays[i].shape);
      EXPECT_EQ(info->arrays[i].frames, of_array(all, i).size());
      EXPECT_EQ(info->arrays[i].lost, lost);
      EXPECT_EQ(info->arrays[i].array_toml, arrays[i].array_toml);
      EXPECT_EQ(info->arrays[i].model_hash, arrays[i].model_hash);
      lost_of_all += lost;
    }
    EXPECT_EQ(info->lost, lost_of_all);
  }
}

TEST(SuitRecording, of_no_frame_tells_its_arrays) {
  const support::TemporaryFolder folder;
  record(folder.file("rec.mcap"), three_arrays(), {});
  const Result<RecordingInfo> info = recording_info(folder.file("rec.mcap"));
  ASSERT_TRUE(info);
  EXPECT_TRUE(info->complete);
  EXPECT_EQ(info->frames, 0U);
  EXPECT_EQ(info->arrays.size(), 3U);
  const auto reader = RecordingReader::open(folder.file("rec.mcap"), "back");
  ASSERT_TRUE(reader);
  RawFrame frame;
  const Result<bool> more = (*reader)->next(frame);
  ASSERT_TRUE(more);
  EXPECT_FALSE(*more);
}

TEST(SuitRecording, of_any_cut_is_recovered_with_its_totals) {
  const support::TemporaryFolder folder;
  const std::vector<RecordedArray> arrays = three_arrays();
  const std::vector<Written> all = interleaved(arrays, 3000, 8);
  record(folder.file("rec.mcap"), arrays, all, {.compression = McapCompression::none});
  const std::string bytes = support::read_bytes(folder.file("rec.mcap"));
  Random random(9);
  for (int i = 0; i < 10; ++i) {
    const std::size_t size = 2000 + random.below(bytes.size() - 2000);
    SCOPED_TRACE(size);
    support::write_bytes(folder.file("cut.mcap"), bytes.substr(0, size));
    const std::vector<Written> readable = read_suit(folder.file("cut.mcap"));
    const Result<Recovery> recovery = recover_recording(folder.file("cut.mcap"), folder.file("whole.mcap"));
    ASSERT_EQ(recovery.has_value(), !readable.empty());
    if (readable.empty()) continue;
    ASSERT_TRUE(recovery) << recovery.error().message;
    EXPECT_EQ(recovery->frames, readable.size());
    expect_same(read_suit(folder.file("whole.mcap")), readable);
    const Result<RecordingInfo> info = recording_info(folder.file("whole.mcap"));
    ASSERT_TRUE(info);
    ASSERT_EQ(info->arrays.size(), 3U);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(info->arrays[k].frames, of_array(readable, k).size());
      EXPECT_EQ(info->arrays[k].model_hash, arrays[k].model_hash);
      EXPECT_EQ(info->arrays[k].array_toml, arrays[k].array_toml);
    }
  }
}

TEST(SuitRecording, that_is_damaged_is_read_or_gives_an_error) {
  const support::TemporaryFolder folder;
  record(folder.file("rec.mcap"), three_arrays(), interleaved(three_arrays(), 30, 10));
  const std::string bytes = support::read_bytes(folder.file("rec.mcap"));
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    support::write_bytes(folder.file("damaged.mcap"), support::mutated(bytes, seed));
    const auto reader = SuitRecordingReader::open(folder.file("damaged.mcap"));
    if (!reader) continue;
    Written read;
    for (int pass = 0; pass < 2; ++pass) {
      Result<bool> more = true;
      while (more && *more) {
        more = (*reader)->next(read.array, read.frame);
        if (!more || !*more) break;
        ASSERT_LT(read.array, (*reader)->arrays().size());
        EXPECT_EQ(read.frame.counts.size(), (*reader)->arrays()[read.array].shape.taxel_count());
      }
      (*reader)->seek(kStart + std::chrono::milliseconds(15));
    }
  }
}

TEST(SuitRecording, seek_goes_on_with_the_first_frames_of_a_time_or_later) {
  const support::TemporaryFolder folder;
  const std::vector<RecordedArray> arrays = large_arrays();
  const std::vector<Written> all = interleaved(arrays, 50, 11);
  record(folder.file("rec.mcap"), arrays, all, {.compression = McapCompression::none});
  const std::string bytes = support::read_bytes(folder.file("rec.mcap"));
  support::write_bytes(folder.file("cut.mcap"), bytes.substr(0, bytes.size() - 10));
  Random random(12);
  for (const char* name : {"rec.mcap", "cut.mcap"}) {
    SCOPED_TRACE(name);
    const auto suit = SuitRecordingReader::open(folder.file(name));
    ASSERT_TRUE(suit) << suit.error().message;
    for (int i = 0; i < 6; ++i) {
      const auto millis = static_cast<std::int64_t>(random.below(54)) - 2;
      SCOPED_TRACE(millis);
      const Nanos time = kStart + std::chrono::milliseconds(millis) - Nanos(i % 2);
      std::vector<Written> later = all;
      std::erase_if(later, [&](const Written& written) { return written.frame.time < time; });
      (*suit)->seek(time);
      if (i % 3 != 0) {
        expect_same(read_suit(**suit), later);
        continue;
      }
      const auto one = RecordingReader::open(folder.file(name), "b");
      ASSERT_TRUE(one);
      (*one)->seek(time);
      support::expect_same_frames(**one, of_array(later, 1));
    }
  }
}

TEST(SuitRecording, a_file_that_is_none_is_refused) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("rec.mcap"), "no recording");
  EXPECT_FALSE(SuitRecordingReader::open(folder.file("rec.mcap")));
  EXPECT_FALSE(SuitRecordingReader::open(folder.file("nothing.mcap")));
}

}  // namespace
}  // namespace dermis::bytes::recordings
