// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/frame_batches.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/recording.hpp"
#include "support/mutations.hpp"
#include "support/random_frames.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr Nanos kStart{1'760'000'000'000'000'000};
const RecordedArray kArray{.name = "chest", .shape = {4, 5}, .array_toml = "[array]\n", .model_hash = "fnv1a64:1"};

std::vector<RawFrame> frames_every(Nanos period, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<RawFrame> frames;
  for (std::size_t i = 0; i < count; ++i) {
    frames.push_back(support::random_frame(random, kArray.shape.taxel_count(), support::RandomCounts::any_bits));
    frames.back().time = kStart + static_cast<std::int64_t>(i) * period;
    frames.back().acquisition.lost_before = 0;
  }
  return frames;
}

std::vector<FrameBatch> take_all(FrameBatchWriter& writer) {
  std::vector<FrameBatch> batches;
  while (std::optional<FrameBatch> batch = writer.take(true)) batches.push_back(*std::move(batch));
  return batches;
}

TEST(FrameBatches, every_frame_reads_back_with_the_same_bits) {
  FrameBatchWriter writer(kArray);
  const std::vector<RawFrame> frames = frames_every(std::chrono::milliseconds(7), 200, 1);
  for (const RawFrame& frame : frames) writer.add(frame);
  std::size_t next = 0;
  for (const FrameBatch& batch : take_all(writer)) {
    const Result<ReadBatch> read = read_frame_batch(writer.description(), batch.bytes);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->array.name, "chest");
    EXPECT_EQ(read->array.shape, kArray.shape);
    EXPECT_EQ(read->array.array_toml, kArray.array_toml);
    EXPECT_EQ(read->array.model_hash, kArray.model_hash);
    ASSERT_EQ(read->frames.size(), batch.frames);
    for (const RawFrame& frame : read->frames) support::expect_same_frame(frame, frames[next++]);
  }
  EXPECT_EQ(next, frames.size());
}

TEST(FrameBatches, contacts_have_batches_of_their_own) {
  FrameBatchWriter writer(kArray);
  for (const RawFrame& frame : frames_every(std::chrono::milliseconds(7), 10, 9)) {
    writer.add(frame);
    writer.add_contacts(frame.time, std::vector<std::uint8_t>(100, 7));
  }
  const std::optional<FrameBatch> contacts = writer.take_contacts(true);
  ASSERT_TRUE(contacts);
  EXPECT_EQ(contacts->frames, 10U);
  EXPECT_EQ(contacts->first, kStart);
  EXPECT_LT(contacts->bytes.size(), 1000U);
  EXPECT_FALSE(writer.take_contacts(true));
  const std::optional<FrameBatch> frames = writer.take(true);
  ASSERT_TRUE(frames);
  std::vector<std::uint8_t> both = contacts->bytes;
  both.insert(both.end(), frames->bytes.begin(), frames->bytes.end());
  const Result<ReadBatch> read = read_frame_batch(writer.description(), both);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->frames.size(), 10U);
}

TEST(FrameBatches, a_batch_spans_a_tenth_of_a_second_at_most) {
  FrameBatchWriter writer(kArray);
  for (const RawFrame& frame : frames_every(std::chrono::milliseconds(7), 200, 2)) writer.add(frame);
  EXPECT_TRUE(writer.take(false));
  for (const FrameBatch& batch : take_all(writer)) EXPECT_LE(batch.last - batch.first, FrameBatchWriter::kLongest);
}

TEST(FrameBatches, a_begun_batch_is_taken_only_where_that_is_asked) {
  FrameBatchWriter writer(kArray);
  writer.add(frames_every(std::chrono::milliseconds(7), 1, 3).front());
  EXPECT_FALSE(writer.take(false));
  EXPECT_TRUE(writer.take(true));
  EXPECT_FALSE(writer.take(true));
}

TEST(FrameBatches, the_description_and_its_batches_are_a_recording) {
  const support::TemporaryFolder folder;
  FrameBatchWriter writer(kArray);
  const std::vector<RawFrame> frames = frames_every(std::chrono::milliseconds(7), 100, 4);
  for (const RawFrame& frame : frames) writer.add(frame);
  std::string file(writer.description().begin(), writer.description().end());
  for (const FrameBatch& batch : take_all(writer)) file.append(batch.bytes.begin(), batch.bytes.end());
  support::write_bytes(folder.file("rec.mcap"), file);
  const auto reader = RecordingReader::open(folder.file("rec.mcap"));
  ASSERT_TRUE(reader) << reader.error().message;
  support::expect_same_frames(**reader, frames);
}

TEST(FrameBatches, frames_without_room_are_counted_and_the_next_one_says_so) {
  FrameBatchWriter writer({.name = "large", .shape = {512, 512}});
  RawFrame frame;
  frame.counts.resize(std::size_t{512} * 512);
  frame.acquisition.lost_before = 1;
  for (int i = 0; i < 40; ++i) writer.add(frame);
  const std::uint64_t left_out = writer.left_out();
  EXPECT_GT(left_out, 0U);
  const std::size_t kept = take_all(writer).size();
  EXPECT_EQ(kept + left_out, 40U);
  writer.add(frame);
  const Result<ReadBatch> read = read_frame_batch(writer.description(), writer.take(true)->bytes);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->frames.front().acquisition.lost_before, 2 * left_out + 1);
}

TEST(FrameBatches, changed_bytes_are_an_error_of_one_line_or_other_frames) {
  FrameBatchWriter writer(kArray);
  for (const RawFrame& frame : frames_every(std::chrono::milliseconds(7), 5, 5)) writer.add(frame);
  const FrameBatch batch = *writer.take(true);
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const std::string changed = support::mutated(std::string(batch.bytes.begin(), batch.bytes.end()), seed);
    const std::vector<std::uint8_t> bytes(changed.begin(), changed.end());
    const Result<ReadBatch> read = read_frame_batch(writer.description(), bytes);
    if (read) continue;
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos) << "seed " << seed;
  }
}

}  // namespace
}  // namespace dermis::bytes::recordings
