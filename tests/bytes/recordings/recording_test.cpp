// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <sstream>
#include <thread>

#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/disk_calls.hpp"
#include "support/full_disk.hpp"
#include "support/mutations.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr FrameShape kShape{3, 5};

/// A frame with every field set or empty by chance.
RawFrame random_frame(Random& random, const FrameShape& shape) {
  RawFrame frame;
  frame.time = Nanos(static_cast<std::int64_t>(random.bits()));
  if (random.below(2) == 0) frame.temperature_celsius = random.uniform(-20.0, 60.0);
  if (random.below(2) == 0) frame.supply_v = random.uniform(3.0, 5.0);
  if (random.below(2) == 0) frame.acquisition.sequence = random.bits();
  if (random.below(2) == 0) frame.acquisition.device_time = Nanos(static_cast<std::int64_t>(random.bits()));
  frame.acquisition.arrival_steady = Nanos(static_cast<std::int64_t>(random.bits()));
  frame.acquisition.arrival_utc = Nanos(static_cast<std::int64_t>(random.bits() >> 1U));
  frame.acquisition.lost_before = static_cast<std::uint32_t>(random.below(3));
  frame.acquisition.held_taxels = static_cast<std::uint32_t>(random.below(3));
  frame.counts.resize(shape.taxel_count());
  const bool is_fractional = random.below(4) == 0;
  for (float& count : frame.counts) {
    count = static_cast<float>(random.below(4096)) + (is_fractional ? 0.25F : 0.0F);
    if (is_fractional && random.below(5) == 0) count = std::numeric_limits<float>::quiet_NaN();
  }
  return frame;
}

void expect_same(const RawFrame& a, const RawFrame& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.temperature_celsius, b.temperature_celsius);
  EXPECT_EQ(a.supply_v, b.supply_v);
  EXPECT_EQ(a.acquisition, b.acquisition);
  ASSERT_EQ(a.counts.size(), b.counts.size());
  EXPECT_EQ(std::memcmp(a.counts.data(), b.counts.data(), 4 * a.counts.size()), 0);
}

std::vector<RawFrame> random_frames(std::size_t count, std::uint64_t seed, const FrameShape& shape = kShape) {
  Random random(seed);
  std::vector<RawFrame> frames;
  for (std::size_t i = 0; i < count; ++i) frames.push_back(random_frame(random, shape));
  return frames;
}

void record(const std::string& path, const std::vector<RawFrame>& frames, const RecordingOptions& options = {},
            const FrameShape& shape = kShape) {
  const auto writer = RecordingWriter::create(path, shape, options);
  ASSERT_TRUE(writer) << writer.error().message;
  for (const RawFrame& frame : frames) ASSERT_TRUE((*writer)->write(frame));
  const Status committed = (*writer)->commit();
  ASSERT_TRUE(committed) << committed.error().message;
}

std::vector<RawFrame> read_all(const std::string& path) {
  const auto reader = RecordingReader::open(path);
  EXPECT_TRUE(reader) << reader.error().message;
  std::vector<RawFrame> frames;
  RawFrame frame;
  while (reader) {
    const Result<bool> got_frame = (*reader)->next(frame);
    EXPECT_TRUE(got_frame) << got_frame.error().message;
    if (!got_frame || !*got_frame) break;
    frames.push_back(frame);
  }
  return frames;
}

TEST(Recording, every_frame_reads_back_with_the_same_bits) {
  for (const McapCompression compression : {McapCompression::none, McapCompression::lz4, McapCompression::zstd}) {
    const support::TemporaryFolder folder;
    const std::string path = folder.file("rec.mcap");
    const std::vector<RawFrame> frames = random_frames(500, 1);
    RecordingOptions options;
    options.compression = compression;
    record(path, frames, options);
    const std::vector<RawFrame> again = read_all(path);
    ASSERT_EQ(again.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) expect_same(again[i], frames[i]);
    EXPECT_EQ(folder.file_count(), 1U);
  }
}

TEST(Recording, topics_are_names_of_ros) {
  const support::TemporaryFolder folder;
  for (const auto& [name, topic] :
       {std::pair{"left hand", "/left_hand/raw"}, {"3D", "/array_3D/raw"}, {"", "/array_/raw"}}) {
    RecordingOptions options;
    options.name = name;
    record(folder.file("rec.mcap"), random_frames(2, 2), options);
    const Result<RecordingInfo> info = recording_info(folder.file("rec.mcap"));
    ASSERT_TRUE(info);
    EXPECT_EQ(info->arrays.front().name, name);
    EXPECT_TRUE(std::any_of(info->topics.begin(), info->topics.end(),
                            [&](const RecordingTopic& candidate) { return candidate.name == topic; }));
  }
}

TEST(Recording, description_and_totals_are_said_at_once_and_by_reading_all) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  RecordingOptions options;
  options.name = "palm";
  options.array_toml = "[array]\n";
  options.model_hash = "fnv1a64:12";
  options.simulation = "sim:multitouch";
  options.compression = McapCompression::zstd;
  std::vector<RawFrame> frames = random_frames(100, 3);
  std::uint64_t lost = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].time = Nanos(1'700'000'000'000'000'000 + static_cast<std::int64_t>(i) * 10'000'000);
    lost += frames[i].acquisition.lost_before;
  }
  record(path, frames, options);
  const auto reader = RecordingReader::open(path);
  ASSERT_TRUE(reader);
  EXPECT_EQ((*reader)->notes(), (FrameNotes{"palm", "[array]\n", "fnv1a64:12", "sim:multitouch"}));
  EXPECT_EQ((*reader)->shape(), kShape);
  EXPECT_TRUE((*reader)->complete());

  // Without its end, the file is read to its end.
  const std::string bytes = support::read_bytes(path);
  support::write_bytes(folder.file("cut.mcap"), bytes.substr(0, bytes.size() - 10));
  for (const auto& [name, complete] : {std::pair{"rec.mcap", true}, {"cut.mcap", false}}) {
    SCOPED_TRACE(name);
    const Result<RecordingInfo> info = recording_info(folder.file(name));
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_EQ(info->complete, complete);
    EXPECT_EQ(info->frames, 100U);
    EXPECT_EQ(info->lost, lost);
    EXPECT_DOUBLE_EQ(info->duration_s, 0.99);
    EXPECT_EQ(info->start_utc, Nanos(1'700'000'000'000'000'000));
    EXPECT_EQ(info->arrays.front().shape, kShape);
    EXPECT_EQ(info->compression, "zstd");
    EXPECT_EQ(info->arrays.front().name, "palm");
    EXPECT_EQ(info->arrays.front().array_toml, "[array]\n");
    EXPECT_EQ(info->arrays.front().model_hash, "fnv1a64:12");
    EXPECT_TRUE(info->software_version.starts_with("dermis "));
    ASSERT_EQ(info->topics.size(), 3U) << "raw, acquisition and temperature; there are no forces";
    const auto raw = std::find_if(info->topics.begin(), info->topics.end(),
                                  [](const RecordingTopic& topic) { return topic.name == "/palm/raw"; });
    ASSERT_NE(raw, info->topics.end());
    EXPECT_EQ(raw->type, "sensor_msgs/msg/Image");
    EXPECT_EQ(raw->messages, 100U);
  }
}

/// With the totals of a recording of dermis.
void write_images(const std::string& path, const McapChannel& topic, std::span<const std::uint8_t> image) {
  const auto mcap = McapWriter::create(path, McapCompression::lz4);
  ASSERT_TRUE(mcap);
  (*mcap)->add_metadata({"dermis", {{"name", "palm"}, {"rows", "3"}, {"cols", "4"}}});
  const std::uint16_t channel = (*mcap)->add_channel(topic);
  for (std::uint32_t i = 0; i < 10; ++i) (*mcap)->add_message({channel, i, 1000U + i, 1000U + i, image});
  (*mcap)->add_metadata({"dermis.totals", {{"frames", "10"}, {"lost", "0"}}});
  ASSERT_TRUE((*mcap)->finish());
}

TEST(Recording, information_counts_what_can_be_read_and_says_why_the_rest_is_not) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  const ros_messages::MessageType& type = ros_messages::image_type();
  std::vector<std::uint8_t> image;
  ros_messages::encode_image(random_frames(1, 3)[0], kShape, "palm", image);
  const auto info_of = [&](const McapChannel& topic, std::span<const std::uint8_t> message) {
    write_images(path, topic, message);
    const Result<RecordingInfo> info = recording_info(path);
    EXPECT_TRUE(info && info->topics.size() == 1 && info->topics[0].messages == 10U);
    return info ? *info : RecordingInfo{};
  };
  const RecordingInfo good = info_of({"/palm/raw", "cdr", type.name, "ros2msg", type.definition}, image);
  EXPECT_EQ(good.frames, 10U);
  EXPECT_EQ(good.unread, "");
  const RecordingInfo json = info_of({"/palm/raw", "json", type.name, "ros2msg", type.definition}, image);
  EXPECT_EQ(json.frames, 0U);
  EXPECT_EQ(json.unread, "the images of '/palm/raw' are in 'json'; frames are read in 'cdr'");
  const RecordingInfo bare = info_of({"/palm/raw", "cdr", "", "", ""}, image);
  EXPECT_EQ(bare.frames, 0U);
  EXPECT_NE(bare.unread.find("'/palm/raw' have no schema"), std::string::npos) << bare.unread;
  image.resize(image.size() / 2);
  const RecordingInfo cut = info_of({"/palm/raw", "cdr", type.name, "ros2msg", type.definition}, image);
  EXPECT_EQ(cut.frames, 0U);
  EXPECT_NE(cut.unread.find("an image of '/palm/raw' cannot be read"), std::string::npos) << cut.unread;
}

TEST(Recording, of_no_frame_is_complete) {
  const support::TemporaryFolder folder;
  record(folder.file("rec.mcap"), {});
  const auto reader = RecordingReader::open(folder.file("rec.mcap"));
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_FALSE((*reader)->shape());
  RawFrame frame;
  const Result<bool> got_frame = (*reader)->next(frame);
  ASSERT_TRUE(got_frame);
  EXPECT_FALSE(*got_frame);
  const Result<RecordingInfo> info = recording_info(folder.file("rec.mcap"));
  ASSERT_TRUE(info);
  EXPECT_TRUE(info->complete);
  EXPECT_EQ(info->frames, 0U);
  EXPECT_EQ(info->duration_s, 0.0);
}

TEST(Recording, forces_do_not_change_the_frames) {
  const support::TemporaryFolder folder;
  const std::vector<RawFrame> frames = random_frames(20, 4);
  const auto writer = RecordingWriter::create(folder.file("rec.mcap"), kShape);
  ASSERT_TRUE(writer);
  ForceFrame force;
  force.newtons.assign(kShape.taxel_count(), 1.5F);
  force.sigma_newtons.assign(kShape.taxel_count(), 0.5F);
  force.taxels.assign(kShape.taxel_count(), TaxelStatus::saturated);
  for (const RawFrame& frame : frames) {
    force.time = frame.time;
    ASSERT_TRUE((*writer)->write(frame, force));
  }
  ASSERT_TRUE((*writer)->commit());
  const std::vector<RawFrame> again = read_all(folder.file("rec.mcap"));
  ASSERT_EQ(again.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) expect_same(again[i], frames[i]);
}

TEST(Recording, frames_are_in_the_file_though_none_follows_and_nothing_is_committed) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  support::write_bytes(path, "an old recording");
  const auto writer = RecordingWriter::create(path, kShape);
  ASSERT_TRUE(writer);
  EXPECT_EQ(support::read_bytes(path), "an old recording");
  const std::vector<RawFrame> frames = random_frames(3, 5);
  for (const RawFrame& frame : frames) ASSERT_TRUE((*writer)->write(frame));
  while (support::read_bytes(path) == "an old recording") std::this_thread::yield();  // ctest ends a test that hangs
  const std::vector<RawFrame> again = read_all(path);
  ASSERT_EQ(again.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) expect_same(again[i], frames[i]);
}

TEST(Recording, that_is_not_committed_stays_only_where_it_is_live) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  for (const bool live : {false, true}) {
    support::write_bytes(path, "an old recording");
    RecordingOptions options;
    options.live = live;
    const std::vector<RawFrame> frames = random_frames(3, 6);
    {
      const auto writer = RecordingWriter::create(path, kShape, options);
      ASSERT_TRUE(writer);
      for (const RawFrame& frame : frames) ASSERT_TRUE((*writer)->write(frame));
    }
    EXPECT_EQ(folder.file_count(), 1U);
    if (live) {
      EXPECT_EQ(read_all(path).size(), 3U);
    } else {
      EXPECT_EQ(support::read_bytes(path), "an old recording");
    }
  }
}

TEST(Recording, replaces_an_earlier_one_only_when_its_own_bytes_are_on_the_disk) {
  for (const bool live : {true, false}) {
    SCOPED_TRACE(live);
    const support::TemporaryFolder folder;
    const std::string path = folder.file("rec.mcap");
    support::write_bytes(path, "an old recording");
    RecordingOptions options;
    options.live = live;
    static_cast<void>(support::take_disk_calls());
    const auto writer = RecordingWriter::create(path, kShape, options);
    ASSERT_TRUE(writer);
    for (const RawFrame& frame : random_frames(3, 16)) ASSERT_TRUE((*writer)->write(frame));
    while (live && support::read_bytes(path) == "an old recording")
      std::this_thread::yield();  // ctest ends a test that hangs
    ASSERT_TRUE((*writer)->commit());
    const std::vector<std::string> calls = support::take_disk_calls();
    const auto rename = std::find(calls.begin(), calls.end(), "rename");
    ASSERT_NE(rename, calls.end());
    EXPECT_NE(std::find(calls.begin(), rename, "bytes"), rename);
    EXPECT_NE(std::find(rename, calls.end(), "names"), calls.end());
  }
}

TEST(Recording, a_full_disk_leaves_what_was_written) {
  constexpr FrameShape kLarge{64, 160};
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  const std::vector<RawFrame> frames = random_frames(50, 7, kLarge);
  for (const std::size_t size : {std::size_t{1} << 22U, std::size_t{3'500'000}}) {
    {
      const support::SmallDisk disk(size);
      const auto writer = RecordingWriter::create(path, kLarge);
      ASSERT_TRUE(writer);
      Status written = Done{};
      for (std::size_t i = 0; i < 10000 && written; ++i) written = (*writer)->write(frames[i % frames.size()]);
      ASSERT_FALSE(written);
      EXPECT_EQ(written.error().kind, ErrorKind::failed);
      EXPECT_NE(written.error().message.find("rec.mcap"), std::string::npos);
      EXPECT_FALSE((*writer)->commit());
    }
    const std::vector<RawFrame> again = read_all(path);
    EXPECT_GE(again.size(), 50U);
    for (std::size_t i = 0; i < again.size(); ++i) expect_same(again[i], frames[i % frames.size()]);
    const Result<RecordingInfo> info = recording_info(path);
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_TRUE(info->complete) << "the index had room where the last chunk had none";
    EXPECT_EQ(info->frames, again.size());
  }
}

TEST(Recording, a_disk_that_is_full_from_the_beginning_leaves_the_old_file) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  support::write_bytes(path, "an old recording");
  {
    const support::SmallDisk disk(100);
    const auto writer = RecordingWriter::create(path, kShape);
    ASSERT_TRUE(writer);
    static_cast<void>((*writer)->write(random_frames(1, 8)[0]));
    EXPECT_FALSE((*writer)->commit());
  }
  EXPECT_EQ(support::read_bytes(path), "an old recording");
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(Recording, warm_writing_allocates_nothing) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  constexpr FrameShape kLarge{64, 160};
  const support::TemporaryFolder folder;
  RecordingOptions options;
  options.compression = McapCompression::none;
  const auto writer = RecordingWriter::create(folder.file("rec.mcap"), kLarge, options);
  ASSERT_TRUE(writer);
  const std::vector<RawFrame> frames = random_frames(1, 9, kLarge);
  for (int i = 0; i < 200; ++i) ASSERT_TRUE((*writer)->write(frames[0]));
  std::size_t frames_with_allocations = 0;
  for (int i = 0; i < 200; ++i) {
    const support::AllocationGuard guard;
    ASSERT_TRUE((*writer)->write(frames[0]));
    if (guard.count() > 0) ++frames_with_allocations;
  }
  EXPECT_LE(frames_with_allocations, 8U) << "only where chunks wait for the disk";
  ASSERT_TRUE((*writer)->commit());
}

TEST(Recording, log_times_never_go_back) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  std::vector<RawFrame> frames = random_frames(4, 10);
  const std::int64_t times[] = {1000, 900, -5, 2000};
  for (std::size_t i = 0; i < 4; ++i) frames[i].time = Nanos(times[i]);
  record(path, frames);
  const auto mcap = McapReader::open(path);
  ASSERT_TRUE(mcap);
  McapMessage message;
  std::uint64_t before = 0;
  while (*(*mcap)->next(message)) {
    EXPECT_GE(message.log_time, before);
    before = message.log_time;
  }
  EXPECT_EQ(before, 2000U);
  const std::vector<RawFrame> again = read_all(path);
  ASSERT_EQ(again.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) expect_same(again[i], frames[i]);
}

TEST(Recording, steps_of_the_utc_clock_move_no_log_time) {
  constexpr std::int64_t kBegin = 1'700'000'000'000'000'000;
  constexpr std::int64_t kHour = 3'600'000'000'000;
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  std::vector<RawFrame> frames = random_frames(30, 15);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::int64_t taken = kBegin + static_cast<std::int64_t>(i) * 10'000'000;
    frames[i].time = Nanos(taken);
    // NTP after boot, then a step back.
    frames[i].acquisition.arrival_utc = Nanos(taken + (i < 10 ? 0 : i < 20 ? 200'000 * kHour : -kHour));
  }
  record(path, frames);
  const auto mcap = McapReader::open(path);
  ASSERT_TRUE(mcap);
  McapMessage message;
  while (*(*mcap)->next(message))
    EXPECT_EQ(message.log_time, static_cast<std::uint64_t>(frames.at(message.sequence).time.count()));
  const Result<RecordingInfo> info = recording_info(path);
  ASSERT_TRUE(info);
  EXPECT_DOUBLE_EQ(info->duration_s, 0.29);
  EXPECT_EQ(info->start_utc, Nanos(kBegin));
  const std::vector<RawFrame> again = read_all(path);
  ASSERT_EQ(again.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) expect_same(again[i], frames[i]);
}

constexpr FrameShape kHuge{1024, 520};  // 1 MiB of words

/// A recording of `chunks` chunks of a frame each, by closing the writer's chunks through its size.
std::string recording_of_chunks(const support::TemporaryFolder& folder, std::size_t chunks,
                                std::vector<RawFrame>& frames) {
  frames.assign(1, RawFrame{});
  frames[0].counts.assign(kHuge.taxel_count(), 0.0F);
  for (std::size_t i = 1; i < chunks; ++i) frames.push_back(frames[0]);
  for (std::size_t i = 0; i < chunks; ++i) {
    frames[i].time = Nanos(static_cast<std::int64_t>(i + 1));
    frames[i].acquisition.lost_before = 1;
    for (std::size_t k = i; k < kHuge.taxel_count(); k += 997) frames[i].counts[k] = static_cast<float>(k % 4096);
  }
  RecordingOptions options;
  options.array_toml = "[array]\n";
  record(folder.file("rec.mcap"), frames, options, kHuge);
  return support::read_bytes(folder.file("rec.mcap"));
}

TEST(Recording, a_topic_is_declared_with_its_first_message) {
  const support::TemporaryFolder folder;
  std::vector<RawFrame> frames;
  static_cast<void>(recording_of_chunks(folder, 4, frames));
  frames[2].temperature_celsius = 25.0;
  record(folder.file("rec.mcap"), frames, {}, kHuge);
  const std::string bytes = support::read_bytes(folder.file("rec.mcap"));
  support::write_bytes(folder.file("cut.mcap"),
                       bytes.substr(0, bytes.size() - 10));  // without index: read from its beginning
  const auto mcap = McapReader::open(folder.file("cut.mcap"));
  ASSERT_TRUE(mcap);
  EXPECT_TRUE((*mcap)->channels().empty());
  McapMessage message;
  std::size_t messages = 0;
  while (*(*mcap)->next(message)) {
    EXPECT_EQ((*mcap)->channels().size(), message.sequence < 2 ? 2U : 3U);
    ++messages;
  }
  EXPECT_EQ(messages, 2U * 4U + 1U);
  const Result<RecordingInfo> info = recording_info(folder.file("rec.mcap"));
  ASSERT_TRUE(info);
  for (const RecordingTopic& topic : info->topics) EXPECT_GT(topic.messages, 0U) << topic.name;
  EXPECT_EQ(read_all(folder.file("rec.mcap")).at(2).temperature_celsius, 25.0);
}

TEST(Recovery, of_any_cut_keeps_all_whole_chunks) {
  const support::TemporaryFolder folder;
  std::vector<RawFrame> frames;
  const std::string bytes = recording_of_chunks(folder, 8, frames);
  Random random(11);
  for (int i = 0; i < 30; ++i) {
    const std::size_t size = 8 + random.below(bytes.size() - 8);
    SCOPED_TRACE(size);
    support::write_bytes(folder.file("cut.mcap"), bytes.substr(0, size));
    const std::vector<RawFrame> readable = read_all(folder.file("cut.mcap"));
    const Result<Recovery> recovery = recover_recording(folder.file("cut.mcap"), folder.file("whole.mcap"));
    ASSERT_TRUE(recovery || readable.empty());
    if (readable.empty()) continue;
    ASSERT_TRUE(recovery) << recovery.error().message;
    EXPECT_FALSE(recovery->was_complete);
    EXPECT_EQ(recovery->frames, readable.size());
    const std::vector<RawFrame> again = read_all(folder.file("whole.mcap"));
    ASSERT_EQ(again.size(), readable.size());
    for (std::size_t k = 0; k < again.size(); ++k) expect_same(again[k], frames[k]);
    const Result<RecordingInfo> info = recording_info(folder.file("whole.mcap"));
    ASSERT_TRUE(info);
    EXPECT_TRUE(info->complete);
    EXPECT_EQ(info->lost, again.size());
  }
}

TEST(Recovery, of_nothing_is_an_error_and_leaves_what_was_there) {
  const support::TemporaryFolder folder;
  record(folder.file("rec.mcap"), random_frames(20, 12));
  std::string bytes = support::read_bytes(folder.file("rec.mcap"));
  const std::size_t chunk = bytes.find(std::string("\x03\0\0\0lz4", 7));
  support::write_bytes(folder.file("cut.mcap"), bytes.substr(0, chunk + 20));
  support::write_bytes(folder.file("whole.mcap"), "what was there");
  const Result<Recovery> recovery = recover_recording(folder.file("cut.mcap"), folder.file("whole.mcap"));
  ASSERT_FALSE(recovery);
  EXPECT_EQ(recovery.error().kind, ErrorKind::failed);
  EXPECT_EQ(recovery.error().message, folder.file("cut.mcap") + ": nothing can be recovered");
  EXPECT_EQ(support::read_bytes(folder.file("whole.mcap")), "what was there");
}

TEST(Recovery, of_a_whole_file_loses_nothing) {
  const support::TemporaryFolder folder;
  const std::vector<RawFrame> frames = random_frames(50, 12);
  record(folder.file("rec.mcap"), frames);
  const Result<Recovery> recovery = recover_recording(folder.file("rec.mcap"), folder.file("again.mcap"));
  ASSERT_TRUE(recovery);
  EXPECT_TRUE(recovery->was_complete);
  EXPECT_EQ(recovery->frames, 50U);
  EXPECT_EQ(recovery->lost_bytes, 0U);
  EXPECT_EQ(recovery->damaged_chunks, 0U);
  const std::vector<RawFrame> again = read_all(folder.file("again.mcap"));
  ASSERT_EQ(again.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) expect_same(again[i], frames[i]);
}

TEST(Recovery, leaves_out_damaged_chunks_and_says_how_many_messages_they_had) {
  const support::TemporaryFolder folder;
  std::vector<RawFrame> frames;
  const std::string bytes = recording_of_chunks(folder, 6, frames);
  const auto damage = [&](std::size_t chunk, std::size_t offset) {
    std::string damaged = bytes;
    std::size_t place = 0;
    for (std::size_t i = 0; i <= chunk; ++i) {
      place = damaged.find(std::string("\x03\0\0\0lz4", 7), place + 1);
    }
    damaged[place + offset] = static_cast<char>(damaged[place + offset] ^ 0x55);
    return damaged;
  };
  // Into the data of the chunk, and into the length of its record.
  for (const std::size_t offset : {std::size_t{100}, std::size_t(0) - 28 - 6}) {
    SCOPED_TRACE(offset);
    support::write_bytes(folder.file("damaged.mcap"), damage(2, offset));
    const Result<Recovery> recovery = recover_recording(folder.file("damaged.mcap"), folder.file("whole.mcap"));
    ASSERT_TRUE(recovery) << recovery.error().message;
    EXPECT_EQ(recovery->frames, 5U);
    EXPECT_GT(recovery->lost_bytes, 1000U);
    if (offset == 100) {
      EXPECT_EQ(recovery->damaged_chunks, 1U);
      EXPECT_EQ(recovery->lost_messages, 2U);  // acquisition and image
    }
    std::vector<RawFrame> expected = frames;
    expected.erase(expected.begin() + 2);
    const std::vector<RawFrame> again = read_all(folder.file("whole.mcap"));
    ASSERT_EQ(again.size(), expected.size());
    for (std::size_t i = 0; i < again.size(); ++i) expect_same(again[i], expected[i]);
    const auto reader = RecordingReader::open(folder.file("whole.mcap"));
    ASSERT_TRUE(reader);
    EXPECT_EQ((*reader)->notes().array_toml, "[array]\n");
  }
}

TEST(Recovery, refuses_to_replace_what_it_reads) {
  const support::TemporaryFolder folder;
  record(folder.file("rec.mcap"), random_frames(3, 13));
  const std::string before = support::read_bytes(folder.file("rec.mcap"));
  const Result<Recovery> recovery = recover_recording(folder.file("rec.mcap"), folder.file("rec.mcap"));
  ASSERT_FALSE(recovery);
  EXPECT_EQ(recovery.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(support::read_bytes(folder.file("rec.mcap")), before);
}

TEST(Recovery, of_any_damage_ends_with_a_readable_file_or_an_error) {
  const support::TemporaryFolder folder;
  record(folder.file("rec.mcap"), random_frames(30, 14));
  const std::string bytes = support::read_bytes(folder.file("rec.mcap"));
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    support::write_bytes(folder.file("damaged.mcap"), support::mutated(bytes, seed));
    const Result<Recovery> recovery = recover_recording(folder.file("damaged.mcap"), folder.file("whole.mcap"));
    if (!recovery) continue;
    const Result<RecordingInfo> info = recording_info(folder.file("whole.mcap"));
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_TRUE(info->complete);
    EXPECT_EQ(info->frames, recovery->frames);
  }
}

/// Counts what is read of it.
class CountedText final : public std::stringbuf {
 public:
  CountedText(const std::string& text, std::uint64_t& bytes_read) : std::stringbuf(text), bytes_read_(&bytes_read) {}

 protected:
  std::streamsize xsgetn(char* to, std::streamsize count) override {
    *bytes_read_ += static_cast<std::uint64_t>(count);
    return std::stringbuf::xsgetn(to, count);
  }

 private:
  std::uint64_t* bytes_read_;
};

class CountedStream final : public std::istream {
 public:
  CountedStream(const std::string& text, std::uint64_t& bytes_read) : std::istream(nullptr), text_(text, bytes_read) {
    rdbuf(&text_);
  }

 private:
  CountedText text_;
};

std::string number_text(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xFFU);
  return text;
}

/// A chunk up to its records, without compression.
std::string begin_of_chunk(std::uint64_t bytes, std::uint32_t crc) {
  return "\x06" + number_text(8 + 8 + 8 + 4 + 4 + 8 + bytes, 8) + std::string(16, '\0') + number_text(bytes, 8) +
         number_text(crc, 4) + number_text(0, 4) + number_text(bytes, 8);
}

TEST(Recovery, of_a_file_made_to_keep_it_busy_reads_a_bounded_multiple_of_the_file) {
  const std::string magic("\x89MCAP0\r\n");
  std::string overlapping = magic + '\0';
  for (int i = 0; i < 30'000; ++i) overlapping += begin_of_chunk(std::uint64_t{2} << 20U, 1);
  overlapping.append(std::size_t{2} << 20U, '\0');
  // Chunks without checksum whose records are none, and messages of no channel behind them.
  std::string walked_again = magic + '\0';
  for (int i = 0; i < 3'000; ++i) walked_again += begin_of_chunk(20, 0) + std::string(20, '\x05');
  for (int i = 0; i < 20'000; ++i) walked_again += "\x05" + number_text(100, 8) + std::string(100, '\0');
  walked_again += '\0';
  std::string far_apart = magic;
  for (int i = 0; i < 20'000; ++i) far_apart += begin_of_chunk(0, 0) + '\0';

  const support::TemporaryFolder folder;
  for (const std::string& text : {overlapping, walked_again, far_apart}) {
    std::uint64_t bytes_read = 0;
    const Result<Recovery> recovery =
        recover_recording(std::make_unique<CountedStream>(text, bytes_read), "hostile", folder.file("whole.mcap"));
    EXPECT_FALSE(recovery && recovery->messages > 0);
    EXPECT_LE(bytes_read, (std::uint64_t{300} << 20U) + 150 * text.size()) << text.size();
  }
}

}  // namespace
}  // namespace dermis::bytes::recordings
